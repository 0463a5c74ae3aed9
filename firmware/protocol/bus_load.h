// Worst-case load of each bus, computed from the dictionary.
#pragma once

#include "firmware/protocol/dictionary.h"
#include "hal/can_timing.h"

namespace hoof::firmware::protocol {

inline constexpr double kBitRate_Hz = 1e6;
inline constexpr double kLargestLoad_ratio = 0.70;  // keeps room for repeats after bus errors

/// Share of the bus taken when every message comes at its shortest period, each frame stuffed at
/// its worst.
constexpr double worst_load_ratio(BusMask bus) {
  double bits_per_s = 0.0;
  for (const MessageSpec& message : kMessages) {
    if ((message.buses & bus) == 0) continue;
    bits_per_s += hal::worst_classic_frame_bits(message.length) * 1000.0 / message.shortest_ms;
  }
  return bits_per_s / kBitRate_Hz;
}

static_assert(worst_load_ratio(kBus0) <= kLargestLoad_ratio);
static_assert(worst_load_ratio(kBus1) <= kLargestLoad_ratio);

}  // namespace hoof::firmware::protocol
