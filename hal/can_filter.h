// Acceptance filter: what a node wants to hear. Same meaning on every bus implementation.
#pragma once

#include <cstdint>

#include "hal/can_frame.h"

namespace hoof::hal {

struct CanFilter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0;  // bits of `id` that must match
  bool extended = false;   // a filter passes one identifier format only

  constexpr bool accepts(const CanFrame& frame) const {
    return frame.extended == extended && ((frame.id ^ id) & mask) == 0;
  }
};

}  // namespace hoof::hal
