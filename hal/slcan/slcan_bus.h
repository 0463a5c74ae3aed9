// A CAN bus over a serial line, this node being what the other side takes for its adapter: it
// answers O (open), C (close), S and s (bit rate: none here), Z0 (no time stamps), V and N
// (version, serial number), and hands over frames while it is open. Every other line is refused.
//
// Bytes come from an interrupt, which puts whole frames into a queue; everything else belongs to
// the main loop.
//
// A template, and no interface between bus and line: what the deepest chain of calls on the board
// is stays known (tools/hoof firmware build).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/can_bus.h"
#include "hal/can_frame_check.h"
#include "hal/interrupt_lock.h"
#include "hal/receive_queue.h"
#include "hal/slcan/line.h"

namespace hoof::hal::slcan {

/// @tparam Port with `bool write(std::span<const std::uint8_t>)`, all or nothing, from the
/// interrupt or with interrupts masked, and `std::size_t room() const`, the bytes it takes now
template <typename Port>
class SlcanBus final : public CanBus {
 public:
  static constexpr std::uint32_t kQueue = 16;  // frames; one more is dropped and counted

  explicit SlcanBus(Port& port) : port_(port) {}

  /// From the interrupt, in order.
  void on_byte(std::uint8_t byte, std::int64_t now_ns);
  /// From the interrupt: a byte was lost, so that the line it belongs to is not one.
  void on_lost_byte();

  /// Refuses everything from now on, until a reset.
  void close_for_good() { shut_.store(true, std::memory_order_relaxed); }
  bool open() const {
    return open_.load(std::memory_order_relaxed) && !shut_.load(std::memory_order_relaxed);
  }
  bool frame_waiting() const { return !queue_.empty(); }

  /// kDown while it is not open.
  SendResult send(const CanFrame& frame) override;
  bool receive(CanFrame& frame) override;
  BusStatus status() const override;
  bool bus_off() const override { return false; }

 private:
  void take_line(std::int64_t now_ns);
  bool take_frame(std::int64_t now_ns);
  void answer(std::span<const std::uint8_t> text, std::uint8_t end);

  static constexpr std::array<std::uint8_t, 5> kVersion = {'V', '0', '1', '0', '0'};
  static constexpr std::array<std::uint8_t, 5> kSerialNumber = {'N', 'H', 'O', 'O', 'F'};

  struct Held {
    std::uint32_t id = 0;
    bool extended = false, remote = false;
    std::uint8_t length = 0;
    std::array<std::uint8_t, 8> data{};
    std::int64_t stamp_ns = 0;
  };

  Port& port_;
  std::atomic<bool> open_{false}, shut_{false};
  ReceiveQueue<Held, kQueue, 0> queue_;
  std::uint64_t sent_ = 0, received_ = 0;  // by the main loop

  // By the interrupt.
  Line line_;            // so far
  bool broken_ = false;  // this line is too long, or a byte of it was lost
  std::uint64_t dropped_ = 0;
};

template <typename Port>
void SlcanBus<Port>::on_byte(std::uint8_t byte, std::int64_t now_ns) {
  if (byte != kEnd) {
    if (byte == '\n') return;  // of a terminal that ends its lines with both
    if (line_.length == line_.text.size()) broken_ = true;
    if (!broken_) line_.text[line_.length++] = byte;
    return;
  }
  if (broken_ || shut_.load(std::memory_order_relaxed)) {
    answer({}, kRefused);
  } else {
    take_line(now_ns);
  }
  line_.length = 0;
  broken_ = false;
}

template <typename Port>
void SlcanBus<Port>::on_lost_byte() {
  broken_ = true;
}

template <typename Port>
void SlcanBus<Port>::take_line(std::int64_t now_ns) {
  const std::span<const std::uint8_t> text = line_.bytes();
  if (text.empty()) return answer({}, kEnd);
  switch (text[0]) {
    case 'O':
    case 'C':
      if (text.size() != 1) break;
      open_.store(text[0] == 'O', std::memory_order_relaxed);
      return answer({}, kEnd);
    case 'S':
    case 's':
      return answer({}, kEnd);
    case 'Z':
      if (text.size() != 2 || text[1] != '0') break;  // no time stamps
      return answer({}, kEnd);
    case 'V':
      return answer(kVersion, kEnd);
    case 'N':
      return answer(kSerialNumber, kEnd);
    default:
      if (open() && take_frame(now_ns)) {
        const std::uint8_t taken = text[0] == 'T' || text[0] == 'R' ? 'Z' : 'z';
        return answer({&taken, 1}, kEnd);
      }
  }
  answer({}, kRefused);
}

template <typename Port>
bool SlcanBus<Port>::take_frame(std::int64_t now_ns) {
  CanFrame frame;
  if (!slcan::frame_of(line_.bytes(), frame)) return false;
  Held held{frame.id, frame.extended, frame.remote, frame.length, {}, now_ns};
  for (std::size_t i = 0; i < held.data.size(); ++i) held.data[i] = frame.data[i];
  if (queue_.put(held, false)) return true;
  ++dropped_;
  return false;
}

/// An answer that finds no room is lost: frames matter more, and the other side does not wait.
template <typename Port>
void SlcanBus<Port>::answer(std::span<const std::uint8_t> text, std::uint8_t end) {
  Line line;
  for (const std::uint8_t byte : text) line.text[line.length++] = byte;
  line.text[line.length++] = end;
  port_.write(line.bytes());
}

template <typename Port>
SendResult SlcanBus<Port>::send(const CanFrame& frame) {
  if (!can_exist(frame) || frame.fd) return SendResult::kInvalid;
  if (!open()) return SendResult::kDown;
  const Line line = line_of(frame);
  const InterruptLock lock;  // answers come from the interrupt
  if (!port_.write(line.bytes())) return SendResult::kFull;
  ++sent_;
  return SendResult::kQueued;
}

template <typename Port>
bool SlcanBus<Port>::receive(CanFrame& frame) {
  Held held;
  if (!queue_.take(held)) return false;
  frame = {};
  frame.id = held.id;
  frame.extended = held.extended;
  frame.remote = held.remote;
  frame.length = held.length;
  for (std::size_t i = 0; i < held.data.size(); ++i) frame.data[i] = held.data[i];
  frame.stamp_ns = held.stamp_ns;
  ++received_;
  return true;
}

template <typename Port>
BusStatus SlcanBus<Port>::status() const {
  BusStatus status;
  const std::size_t lines = port_.room() / kLongestLine;
  status.free = static_cast<std::uint8_t>(lines < 255 ? lines : 255);
  status.sent = sent_;
  status.received = received_;
  const InterruptLock lock;  // 64 bits are two loads
  status.dropped = dropped_;
  return status;
}

}  // namespace hoof::hal::slcan
