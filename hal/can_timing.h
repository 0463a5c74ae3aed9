// How long a frame occupies the wire: exact, from its real bit pattern, and worst case.
//
// Classic frame on the wire (ISO 11898-1:2015, 10.4):
//   SOF 1 | identifier and control: 18 (standard) or 38 (extended) | data 8 n | CRC 15   stuffed
//   CRC delimiter 1 | ACK 1 | ACK delimiter 1 | EOF 7 | intermission 3                   not
//   stuffed
// After five equal bits the sender inserts one opposite bit, which itself counts for the next five.
//
// FD frame:
//   SOF 1 | identifier and control: 21 or 40 | data 8 n                                   stuffed
//   stuff count 4 | CRC 17 (up to 16 bytes) or 21, with a fixed stuff bit before the first and
//   after every fourth bit | CRC delimiter 1 | ACK 1 | ACK delimiter 1 | EOF 7 | intermission 3
// With BRS, the rate changes at the sample point of BRS and back at that of the CRC delimiter.
// Counting BRS as a nominal and the CRC delimiter as a data bit is exact when both sample points
// are at the same fraction of their bit, as is recommended (CiA 601-3).
#pragma once

#include <cstdint>

#include "hal/can_frame.h"

namespace hoof::hal {

inline constexpr int kIntermissionBits = 3;

/// Error flag 6, its echo by the other nodes 6 (the longest superposition), error delimiter 8
/// (ISO 11898-1:2015, 10.4.4), then the intermission.
inline constexpr int kErrorFrameBits = 6 + 6 + 8 + kIntermissionBits;

struct BitRates {
  std::int64_t nominal_Hz = 1'000'000;
  std::int64_t data_Hz = 5'000'000;  // used by FD frames with bit_rate_switch only
};

struct FrameBits {
  int nominal = 0;  // bits at the nominal rate, intermission included
  int data = 0;     // bits at the data rate
  constexpr int total() const { return nominal + data; }
};

/// Bits of this very frame on the wire, stuff bits and intermission included.
/// @pre can_exist(frame)
FrameBits frame_bits(const CanFrame& frame);

/// CRC-15 of a classic frame (polynomial 0x4599, start 0), over SOF to the last data bit.
/// @pre can_exist(frame), not FD
std::uint16_t classic_crc15(const CanFrame& frame);

/// Upper bound for any classic frame of `length` data bytes, intermission included:
///   g + 8 n + 13 + floor((g + 8 n - 1) / 4),  g = 34 standard, 54 extended
/// (Davis, Burns, Bril, Lukkien, "Controller Area Network (CAN) schedulability analysis", 2007, eq.
/// 1). It supposes that every stuffed bit is free; fixed control bits and the CRC keep real frames
/// below.
constexpr int worst_classic_frame_bits(int length, bool extended = false) {
  const int stuffed_region = (extended ? 54 : 34) + 8 * length;
  return stuffed_region + 13 + (stuffed_region - 1) / 4;
}
static_assert(worst_classic_frame_bits(8) == 135);
static_assert(worst_classic_frame_bits(8, true) == 160);

/// Bits from SOF up to and including the first in which the two frames differ on the wire: where a
/// sender that lost no arbitration finds a level it did not send.
/// `first_is_dominant` tells which of them sent the dominant (0) bit there.
/// @pre both can exist and are not equal
struct FirstDifference {
  int bits = 0;
  bool first_is_dominant = false;
};
FirstDifference first_difference(const CanFrame& first, const CanFrame& second);

/// Time of `bits` at the given rates, rounded up to whole nanoseconds.
constexpr std::int64_t bit_time_ns(FrameBits bits, const BitRates& rates) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  const auto at = [](std::int64_t count, std::int64_t rate_Hz) {
    return (count * kNsPerSecond + rate_Hz - 1) / rate_Hz;
  };
  return at(bits.nominal, rates.nominal_Hz) + at(bits.data, rates.data_Hz);
}

/// Time from the start of `frame` until the next one may start.
inline std::int64_t frame_time_ns(const CanFrame& frame, const BitRates& rates = {}) {
  return bit_time_ns(frame_bits(frame), rates);
}

}  // namespace hoof::hal
