#include "hal/can_timing.h"

#include <array>

#include "hal/can_arbitration.h"

namespace hoof::hal {
namespace {

// --- bit stuffing
// --------------------------------------------------------------------------------- State: 0 before
// the first bit; 1..4 that many zeros in a row; 5..8 one to four ones in a row.
constexpr int kStuffStates = 9;

struct StuffStep {
  std::uint8_t next = 0;
  std::uint8_t stuffed = 0;  // stuff bits inserted
};

constexpr StuffStep stuff_one_bit(std::uint8_t state, bool bit) {
  const bool previous = state >= 5;
  const int run = state == 0 ? 0 : (previous ? state - 4 : state);
  const auto state_of = [](bool level, int length) {
    return static_cast<std::uint8_t>(level ? 4 + length : length);
  };
  if (run == 0 || bit != previous) return {state_of(bit, 1), 0};
  if (run < 4) return {state_of(bit, run + 1), 0};
  return {state_of(!bit, 1), 1};  // the fifth equal bit: its opposite follows and starts a new run
}

/// A byte at a time, most significant bit first: the bus counts a million frames a second.
constexpr auto kStuffByte = [] {
  std::array<std::array<StuffStep, 256>, kStuffStates> table{};
  for (int state = 0; state < kStuffStates; ++state) {
    for (int byte = 0; byte < 256; ++byte) {
      StuffStep step{static_cast<std::uint8_t>(state), 0};
      for (int i = 7; i >= 0; --i) {
        const StuffStep one = stuff_one_bit(step.next, ((byte >> i) & 1) != 0);
        step = {one.next, static_cast<std::uint8_t>(step.stuffed + one.stuffed)};
      }
      table[state][byte] = step;
    }
  }
  return table;
}();

/// Counts the stuff bits of a bit stream given in pieces.
class StuffCounter {
 public:
  /// Takes the low `count` bits of `bits`, most significant first.
  void feed(std::uint64_t bits, int count) {
    while (count % 8 != 0) feed_bit(((bits >> --count) & 1) != 0);
    while (count > 0) {
      count -= 8;
      take(kStuffByte[state_][(bits >> count) & 0xFF]);
    }
  }
  void feed_bit(bool bit) { take(stuff_one_bit(state_, bit)); }

  int stuffed() const { return stuffed_; }

 private:
  void take(StuffStep step) {
    state_ = step.next;
    stuffed_ += step.stuffed;
  }
  std::uint8_t state_ = 0;
  int stuffed_ = 0;
};

// --- CRC-15
// ---------------------------------------------------------------------------------------
constexpr std::uint16_t kCrc15Polynomial = 0x4599;  // ISO 11898-1:2015, 10.4.2.6, without x^15

constexpr auto kCrc15Byte = [] {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned crc = byte << 7;
    for (int i = 0; i < 8; ++i) {
      crc = (crc & 0x4000) != 0 ? ((crc << 1) ^ kCrc15Polynomial) : (crc << 1);
    }
    table[byte] = static_cast<std::uint16_t>(crc & 0x7FFF);
  }
  return table;
}();

constexpr std::uint16_t crc15_add(std::uint16_t crc, std::uint8_t byte) {
  return static_cast<std::uint16_t>(((crc << 8) ^ kCrc15Byte[((crc >> 7) ^ byte) & 0xFF]) & 0x7FFF);
}

// --- the bits of a frame
// --------------------------------------------------------------------------
/// SOF to the last bit of the DLC, right-aligned.
struct Header {
  std::uint64_t bits = 0;
  int count = 0;

  constexpr void append(std::uint64_t value, int width) {
    bits = (bits << width) | value;
    count += width;
  }
};

/// The DLC code of an FD payload size (ISO 11898-1:2015, table 5); sizes up to 8 are their own
/// code.
constexpr unsigned dlc_of(std::uint8_t length) {
  if (length <= 8) return length;
  return length <= 24 ? 9U + (length - 12U) / 4U : 13U + (length - 32U) / 16U;
}
static_assert(dlc_of(12) == 9 && dlc_of(24) == 12 && dlc_of(32) == 13 && dlc_of(64) == 15);

constexpr int kFdBitsAfterBrs = 1 + 4;  // ESI, DLC

constexpr Header header_of(const CanFrame& frame) {
  Header header{0, 1};  // SOF is dominant
  const std::uint32_t key = arbitration_key(frame);
  if (frame.extended) {
    header.append(key, 32);  // identifier, SRR, IDE, extension, RTR or RRS
  } else {
    header.append(key >> 19, 13);  // identifier, RTR or RRS, IDE
  }
  if (frame.fd) {
    header.append(0b10, 2);  // FDF, res
    header.append(frame.bit_rate_switch ? 1 : 0, 1);
    header.append(frame.error_state_indicator ? 1 : 0, 1);
  } else {
    header.append(0, frame.extended ? 2 : 1);  // r1 r0, or r0
  }
  header.append(dlc_of(frame.length), 4);
  return header;
}

constexpr int data_bytes(const CanFrame& frame) {
  return frame.remote ? 0 : frame.length;
}

std::uint16_t crc15(const Header& header, const CanFrame& frame) {
  std::uint16_t crc = 0;
  // Zeros in front change nothing, as the register starts at zero: no alignment is needed.
  for (int shift = (header.count - 1) / 8 * 8; shift >= 0; shift -= 8) {
    crc = crc15_add(crc, static_cast<std::uint8_t>(header.bits >> shift));
  }
  for (int i = 0; i < data_bytes(frame); ++i) crc = crc15_add(crc, frame.data[i]);
  return crc;
}

constexpr int kAckBits = 1 + 1;  // slot, delimiter
constexpr int kEndOfFrameBits = 7;
constexpr int kCrcDelimiterBits = 1;

FrameBits classic_bits(const Header& header, const CanFrame& frame) {
  StuffCounter counter;
  counter.feed(header.bits, header.count);
  for (int i = 0; i < data_bytes(frame); ++i) counter.feed(frame.data[i], 8);
  counter.feed(crc15(header, frame), 15);
  const int stuffed_region = header.count + 8 * data_bytes(frame) + 15 + counter.stuffed();
  return {stuffed_region + kCrcDelimiterBits + kAckBits + kEndOfFrameBits + kIntermissionBits, 0};
}

FrameBits fd_bits(const Header& header, const CanFrame& frame) {
  StuffCounter counter;
  counter.feed(header.bits >> kFdBitsAfterBrs, header.count - kFdBitsAfterBrs);
  const int up_to_brs = header.count - kFdBitsAfterBrs + counter.stuffed();

  // A stuff bit due after the last data bit is left out: the first fixed one stands in its place
  // (ISO 11898-1:2015, 10.5), so the very last bit is taken without its consequence.
  const std::uint64_t after_brs = header.bits & ((1U << kFdBitsAfterBrs) - 1);
  if (frame.length == 0) {
    counter.feed(after_brs >> 1, kFdBitsAfterBrs - 1);
  } else {
    counter.feed(after_brs, kFdBitsAfterBrs);
    for (int i = 0; i + 1 < frame.length; ++i) counter.feed(frame.data[i], 8);
    counter.feed(frame.data[frame.length - 1] >> 1, 7);
  }
  const int dynamic = header.count + 8 * frame.length + counter.stuffed() - up_to_brs;

  const int crc_field = 4 + (frame.length <= 16 ? 17 : 21);  // stuff count and CRC
  const int fixed_stuff = 1 + (crc_field - 1) / 4;
  const int fast = dynamic + crc_field + fixed_stuff + kCrcDelimiterBits;
  const int tail = kAckBits + kEndOfFrameBits + kIntermissionBits;
  if (!frame.bit_rate_switch) return {up_to_brs + fast + tail, 0};
  return {up_to_brs + tail, fast};
}

}  // namespace

FrameBits frame_bits(const CanFrame& frame) {
  const Header header = header_of(frame);
  return frame.fd ? fd_bits(header, frame) : classic_bits(header, frame);
}

std::uint16_t classic_crc15(const CanFrame& frame) {
  return crc15(header_of(frame), frame);
}

FirstDifference first_difference(const CanFrame& first, const CanFrame& second) {
  const Header headers[2] = {header_of(first), header_of(second)};
  const auto bit_of = [&](const Header& header, const CanFrame& frame, int i) {
    if (i < header.count) return ((header.bits >> (header.count - 1 - i)) & 1) != 0;
    i -= header.count;
    return ((frame.data[i / 8] >> (7 - i % 8)) & 1) != 0;
  };
  // Frames that agree up to the end of the shorter one's data have the same DLC and the same data;
  // unequal frames therefore differ before that.
  const int end = headers[0].count + 8 * data_bytes(first);
  StuffCounter counter;
  for (int i = 0; i < end; ++i) {
    const bool bit = bit_of(headers[0], first, i);
    if (bit != bit_of(headers[1], second, i)) return {i + 1 + counter.stuffed(), !bit};
    counter.feed_bit(bit);
  }
  return {end + counter.stuffed(), true};
}

}  // namespace hoof::hal
