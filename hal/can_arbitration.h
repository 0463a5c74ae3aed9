// Who wins the wire when several nodes start at the same time.
#pragma once

#include <cstdint>

#include "hal/can_frame.h"

namespace hoof::hal {

/// The arbitration field as a number: the bits in the order in which they go over the wire, a
/// dominant bit being 0, so the smallest key wins (ISO 11898-1:2015, 10.4.2).
///
///   standard: base id (11), RTR, IDE = 0, zeros
///   extended: base id (11), SRR = 1, IDE = 1, id extension (18), RTR
///
/// Hence data before remote of the same identifier, and a standard frame before every extended
/// frame with the same 11 leading bits. FD frames send a dominant RRS where classic ones have RTR.
/// @pre can_exist(frame)
constexpr std::uint32_t arbitration_key(const CanFrame& frame) {
  const std::uint32_t remote = frame.remote ? 1U : 0U;
  if (!frame.extended) return (frame.id << 21) | (remote << 20);
  const std::uint32_t base = frame.id >> 18;
  const std::uint32_t extension = frame.id & 0x3FFFF;
  return (base << 21) | (0b11U << 19) | (extension << 1) | remote;
}

}  // namespace hoof::hal
