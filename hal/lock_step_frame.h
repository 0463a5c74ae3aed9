// How a simulator tells a firmware in another process, or in an emulator behind serial lines, what
// time it is, and learns that it is done.
//
// In lock-step the two processes exchange the foot's own frames and, between them, these three,
// with 29-bit identifiers that no board uses. They are part of the way the frames travel, as a
// mailbox interrupt is on a board: no dictionary knows them, and no recording holds them.
//
//   simulator                                    firmware
//   Begin                                  ->    starts anew at time 0 with the parameters it has
//                                          <-    Done(0)
//   frames that arrived, Go(t, answer)     ->    clock to t, poll
//                                          <-    frames it sends, Done(t): when it must be asked
//                                          next
//   frames that arrived, Go(t)             ->    clock to t, poll; nothing can come of it
//   End                                    ->    the wall's clock again
//                                          <-    End, where the firmware leaves by itself
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "hal/can_frame.h"

namespace hoof::hal::lock_step {

inline constexpr std::uint32_t kFirstId = 0x1E5C0000;
inline constexpr std::uint32_t kBeginId = kFirstId;
inline constexpr std::uint32_t kGoId = kFirstId + 1;
inline constexpr std::uint32_t kDoneId = kFirstId + 2;
inline constexpr std::uint32_t kEndId = kFirstId + 3;

/// Of these frames; a Begin of another version is not answered.
inline constexpr std::uint8_t kVersion = 1;

/// Two 4-bit counts per bus fit in a byte.
inline constexpr int kMostFree = 15;

struct Go {
  std::int64_t time_ns = 0;  // simulated, from Begin on; 48 bits: 78 hours
  bool answer = true;        // Done is waited for
  bool bus_off[2] = {false, false};
  int free[2] = {3, 3};  // frames that each bus takes now
};

struct Done {
  static constexpr std::uint32_t kNever_us = 0xFFFFFFFF;
  std::uint32_t time_us = 0;            // of the Go that is answered, modulo 2^32
  std::uint32_t due_in_us = kNever_us;  // must be polled again then without any frame; 0: at once
};

constexpr void put(CanFrame& frame, int first, int bytes, std::uint64_t value) {
  for (int i = 0; i < bytes; ++i) {
    frame.data[static_cast<std::size_t>(first + i)] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

constexpr std::uint64_t get(const CanFrame& frame, int first, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) {
    value |= std::uint64_t{frame.data[static_cast<std::size_t>(first + i)]} << (8 * i);
  }
  return value;
}

constexpr CanFrame frame_of(std::uint32_t id, std::uint8_t length) {
  CanFrame frame;
  frame.id = id;
  frame.extended = true;
  frame.length = length;
  return frame;
}

constexpr bool is(const CanFrame& frame, std::uint32_t id, std::uint8_t length) {
  return frame.extended && !frame.remote && !frame.error && !frame.fd && frame.id == id &&
         frame.length == length;
}

/// Any of the frames of this file, well formed or not.
constexpr bool is_any(const CanFrame& frame) {
  return frame.extended && frame.id >= kFirstId && frame.id <= kEndId;
}

constexpr CanFrame begin() {
  CanFrame frame = frame_of(kBeginId, 1);
  frame.data[0] = kVersion;
  return frame;
}
constexpr CanFrame end() {
  return frame_of(kEndId, 0);
}
constexpr bool is_begin(const CanFrame& frame) {
  return is(frame, kBeginId, 1) && frame.data[0] == kVersion;
}
constexpr bool is_end(const CanFrame& frame) {
  return is(frame, kEndId, 0);
}

constexpr CanFrame encode(const Go& go) {
  CanFrame frame = frame_of(kGoId, 8);
  put(frame, 0, 6, static_cast<std::uint64_t>(go.time_ns));
  frame.data[6] = static_cast<std::uint8_t>((go.answer ? 1 : 0) | (go.bus_off[0] ? 2 : 0) |
                                            (go.bus_off[1] ? 4 : 0));
  frame.data[7] = static_cast<std::uint8_t>(std::clamp(go.free[0], 0, kMostFree) |
                                            std::clamp(go.free[1], 0, kMostFree) << 4);
  return frame;
}

constexpr std::optional<Go> decode_go(const CanFrame& frame) {
  if (!is(frame, kGoId, 8)) return std::nullopt;
  const std::uint8_t flags = frame.data[6];
  return Go{static_cast<std::int64_t>(get(frame, 0, 6)),
            (flags & 1) != 0,
            {(flags & 2) != 0, (flags & 4) != 0},
            {frame.data[7] & 0xF, frame.data[7] >> 4}};
}

constexpr CanFrame encode(const Done& done) {
  CanFrame frame = frame_of(kDoneId, 8);
  put(frame, 0, 4, done.time_us);
  put(frame, 4, 4, done.due_in_us);
  return frame;
}

constexpr std::optional<Done> decode_done(const CanFrame& frame) {
  if (!is(frame, kDoneId, 8)) return std::nullopt;
  return Done{static_cast<std::uint32_t>(get(frame, 0, 4)),
              static_cast<std::uint32_t>(get(frame, 4, 4))};
}

constexpr std::uint32_t microseconds(std::int64_t time_ns) {
  return static_cast<std::uint32_t>(time_ns / 1000);
}

/// @param due_ns when the firmware must be asked next without any frame; any time before now: at
/// once
constexpr Done done(std::int64_t time_ns, std::int64_t due_ns) {
  // Up to the next whole microsecond: asked too late by less than one, never too early.
  const std::int64_t wait_us = (due_ns - time_ns + 999) / 1000;
  Done done;
  done.time_us = microseconds(time_ns);
  if (wait_us < Done::kNever_us) {
    done.due_in_us = wait_us > 0 ? static_cast<std::uint32_t>(wait_us) : 0;
  }
  return done;
}

}  // namespace hoof::hal::lock_step
