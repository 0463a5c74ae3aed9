// Worst-case load of each bus, computed from the dictionary.
#pragma once

#include "firmware/protocol/dictionary.h"

namespace hoof::firmware::protocol {

inline constexpr double kBitRate_Hz = 1e6;
inline constexpr double kLargestLoad_ratio = 0.70;  // keeps room for repeats after bus errors

/// Bits that a classic frame with an 11-bit identifier takes on the bus, stuffing at its worst and
/// the three bits of inter-frame space included. From start of frame to the CRC (1 + 11 + 1 + 2 +
/// 4 + 8 n + 15 = 34 + 8 n bits) at most one stuff bit follows the first and every further fourth
/// bit; delimiters, acknowledge, end of frame and space (13 bits) are never stuffed (ISO 11898-1).
constexpr int worst_frame_bits(int length) {
  const int stuffed = 34 + 8 * length;
  return stuffed + (stuffed - 1) / 4 + 13;
}

/// Share of the bus taken when every message comes at its shortest period.
constexpr double worst_load_ratio(BusMask bus) {
  double bits_per_s = 0.0;
  for (const MessageSpec& message : kMessages) {
    if ((message.buses & bus) == 0) continue;
    bits_per_s += worst_frame_bits(message.length) * 1000.0 / message.shortest_ms;
  }
  return bits_per_s / kBitRate_Hz;
}

static_assert(worst_load_ratio(kBus0) <= kLargestLoad_ratio);
static_assert(worst_load_ratio(kBus1) <= kLargestLoad_ratio);

}  // namespace hoof::firmware::protocol
