// The fuzzer's bytes, read as numbers and frames; zeros after the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/can_frame.h"

namespace hoof::tests::fuzz {

class ByteSource {
 public:
  explicit ByteSource(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool empty() const { return next_ >= bytes_.size(); }

  std::uint8_t byte() { return empty() ? std::uint8_t{0} : bytes_[next_++]; }
  std::uint16_t word() {
    const unsigned high = byte();
    return static_cast<std::uint16_t>(high << 8 | byte());
  }
  std::uint32_t long_word() {
    const std::uint32_t high = word();
    return high << 16 | word();
  }

  /// The next bytes as payload.
  void fill(hal::CanFrame& frame, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) frame.data[i] = byte();
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
};

/// Flags of a frame from the bits of one byte; 0 is a plain classic data frame. Bits 4 and 5 exist
/// in FD frames only.
inline void set_flags(hal::CanFrame& frame, std::uint8_t bits) {
  frame.extended = (bits & 1u) != 0;
  frame.remote = (bits & 2u) != 0;
  frame.error = (bits & 4u) != 0;
  frame.fd = (bits & 8u) != 0;
  frame.bit_rate_switch = frame.fd && (bits & 16u) != 0;
  frame.error_state_indicator = frame.fd && (bits & 32u) != 0;
}

}  // namespace hoof::tests::fuzz
