// A second, slow opinion on classic CAN frames: one bit at a time, straight from the description of
// the frame format, sharing no code with hal/can_timing. It also reads bits back, with unstuffing
// and CRC.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "hal/can_frame.h"

namespace hoof::test {

using Bits = std::vector<bool>;

inline void append(Bits& bits, std::uint64_t value, int width) {
  for (int i = width - 1; i >= 0; --i) bits.push_back(((value >> i) & 1) != 0);
}

inline unsigned crc15_of(const Bits& bits) {
  unsigned crc = 0;
  for (const bool bit : bits) {
    const bool feedback = bit != (((crc >> 14) & 1) != 0);
    crc = (crc << 1) & 0x7FFF;
    if (feedback) crc ^= 0x4599;
  }
  return crc;
}

inline Bits stuff(const Bits& bits) {
  Bits out;
  int run = 0;
  for (const bool bit : bits) {
    run = (!out.empty() && out.back() == bit) ? run + 1 : 1;
    out.push_back(bit);
    if (run == 5) {
      out.push_back(!bit);
      run = 1;
    }
  }
  return out;
}

/// SOF to the end of the CRC, without stuff bits.
inline Bits unstuffed_classic(const hal::CanFrame& frame) {
  Bits bits{false};
  if (frame.extended) {
    append(bits, frame.id >> 18, 11);
    append(bits, 0b11, 2);  // SRR, IDE
    append(bits, frame.id & 0x3FFFF, 18);
    bits.push_back(frame.remote);
    append(bits, 0, 2);  // r1, r0
  } else {
    append(bits, frame.id, 11);
    bits.push_back(frame.remote);
    append(bits, 0, 2);  // IDE, r0
  }
  append(bits, frame.length, 4);
  if (!frame.remote) {
    for (int i = 0; i < frame.length; ++i) append(bits, frame.data[i], 8);
  }
  append(bits, crc15_of(bits), 15);
  return bits;
}

/// CRC delimiter, ACK, ACK delimiter, EOF, intermission.
inline constexpr int kUnstuffedTail = 1 + 1 + 1 + 7 + 3;

inline int reference_bits(const hal::CanFrame& frame) {
  return static_cast<int>(stuff(unstuffed_classic(frame)).size()) + kUnstuffedTail;
}

/// Reads the stuffed bits from SOF to the end of the CRC.
/// @return nothing when a stuff bit or the CRC is wrong or bits are missing
inline std::optional<hal::CanFrame> read_back(const Bits& wire) {
  Bits bits;
  int run = 0;
  bool last = true;  // the idle wire is recessive
  for (std::size_t i = 0; i < wire.size(); ++i) {
    run = (i > 0 && wire[i] == last) ? run + 1 : 1;
    last = wire[i];
    bits.push_back(wire[i]);
    if (run < 5) continue;
    if (i + 1 == wire.size() || wire[i + 1] == last) return std::nullopt;
    last = wire[++i];
    run = 1;
  }
  std::size_t at = 1;
  const auto take = [&](int width) {
    std::uint32_t value = 0;
    while (width-- > 0 && at < bits.size()) value = (value << 1) | (bits[at++] ? 1U : 0U);
    return value;
  };
  hal::CanFrame frame;
  frame.id = take(11);
  frame.remote = take(1) != 0;
  frame.extended = take(1) != 0;
  if (frame.extended) {
    frame.id = (frame.id << 18) | take(18);
    frame.remote = take(1) != 0;
    take(1);  // r1
  }
  take(1);  // r0
  frame.length = static_cast<std::uint8_t>(take(4));
  if (frame.length > 8) return std::nullopt;
  for (int i = 0; !frame.remote && i < frame.length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(take(8));
  }
  const unsigned expected_crc = crc15_of(Bits(bits.begin(), bits.begin() + static_cast<long>(at)));
  if (take(15) != expected_crc || at != bits.size()) return std::nullopt;
  return frame;
}

/// Any classic frame; every second one is made of long runs, where stuffing happens.
template <typename Generator>
hal::CanFrame random_classic_frame(Generator& random) {
  hal::CanFrame frame;
  frame.extended = (random() & 1) != 0;
  frame.remote = (random() & 7) == 0;
  frame.id = static_cast<std::uint32_t>(random()) & (frame.extended ? 0x1FFF'FFFFU : 0x7FFU);
  frame.length = static_cast<std::uint8_t>(random() % 9);
  const bool runs = (random() & 1) != 0;
  if (runs) frame.id &= static_cast<std::uint32_t>(random()) & static_cast<std::uint32_t>(random());
  constexpr std::uint8_t kRuns[] = {0x00, 0xFF, 0x0F, 0xF0, 0x87, 0x78, 0xC3, 0x3C};
  for (int i = 0; !frame.remote && i < frame.length; ++i) {
    frame.data[i] = runs ? kRuns[random() % 8] : static_cast<std::uint8_t>(random());
  }
  return frame;
}

/// `id#data` in hexadecimal, to paste back what a random test found.
inline std::string describe(const hal::CanFrame& frame) {
  char text[16];
  std::snprintf(text, sizeof text, frame.extended ? "%08X#" : "%03X#", frame.id);
  std::string out = text;
  if (frame.remote) out += "R";
  for (int i = 0; i < frame.length && i < 64; ++i) {
    std::snprintf(text, sizeof text, "%02X", frame.data[i]);
    out += text;
  }
  return out;
}

}  // namespace hoof::test
