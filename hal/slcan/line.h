// CAN frames as lines of text, the LAWICEL protocol ("slcan" of Linux): tIIIL.. is a frame with a
// standard identifier, T one with an extended one, r and R remote requests; identifier, length and
// data in hexadecimal; ended by a carriage return.
//
// Sources: LAWICEL CANUSB manual, "CAN232/CANUSB ASCII commands"; Linux drivers/net/can/slcan. No
// time stamps (Z0).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/can_frame.h"

namespace hoof::hal::slcan {

inline constexpr std::uint8_t kEnd = '\r';      // of a line; alone: done
inline constexpr std::uint8_t kRefused = 0x07;  // bell

/// T, 8 digits, length, 8 bytes, end.
inline constexpr std::size_t kLongestLine = 1 + 8 + 1 + 16 + 1;

struct Line {
  std::array<std::uint8_t, kLongestLine> text{};
  std::size_t length = 0;

  std::span<const std::uint8_t> bytes() const { return {text.data(), length}; }
};

/// @return a line with its end; of length 0 for what the protocol cannot say (CAN FD, frames that
/// cannot exist)
Line line_of(const CanFrame& frame);

/// @param text without the end
/// @return false, `frame` then unchanged, where it is no frame: another command, a digit that is
/// none, a length above 8, too few or too many digits, an identifier of more bits than there are
bool frame_of(std::span<const std::uint8_t> text, CanFrame& frame);

}  // namespace hoof::hal::slcan
