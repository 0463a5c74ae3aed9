// Which CanFrame values can exist on a wire. Every bus asks here before it accepts one.
#pragma once

#include "hal/can_frame.h"

namespace hoof::hal {

inline constexpr std::uint32_t kMaxStandardId = 0x7FF;
inline constexpr std::uint32_t kMaxExtendedId = 0x1FFF'FFFF;

/// Payload sizes that the 4-bit DLC of CAN FD can name (ISO 11898-1:2015, table 5).
constexpr bool is_fd_length(std::uint8_t length) {
  return length <= 8 || length == 12 || length == 16 || length == 20 || length == 24 ||
         length == 32 || length == 48 || length == 64;
}

/// @return true when `frame` can be transmitted on some CAN bus; error frames never can.
/// BRS and ESI are bits of the FD format, so a classic frame that sets them does not exist.
constexpr bool can_exist(const CanFrame& frame) {
  if (frame.error) return false;
  if (frame.id > (frame.extended ? kMaxExtendedId : kMaxStandardId)) return false;
  if (frame.fd) return !frame.remote && is_fd_length(frame.length);
  return frame.length <= CanFrame::kMaxClassicLength && !frame.bit_rate_switch &&
         !frame.error_state_indicator;
}

}  // namespace hoof::hal
