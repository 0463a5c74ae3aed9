// One CAN frame as it is on the wire, classic or FD. No meaning of its payload lives here; the
// message dictionary is firmware/protocol.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hoof::hal {

struct CanFrame {
  static constexpr std::size_t kMaxClassicLength = 8;
  static constexpr std::size_t kMaxFdLength = 64;
  /// Bytes that `data` holds. A board without an operating system has no CAN FD, and no time to
  /// zero and copy 64 bytes for 8: that was a third of the cost of a control tick.
  static constexpr std::size_t kCapacity = __STDC_HOSTED__ ? kMaxFdLength : kMaxClassicLength;

  std::uint32_t id = 0;   // 11 bits, or 29 bits when `extended`
  bool extended = false;  // 29-bit identifier
  bool remote = false;    // remote request: no data; classic frames only
  bool error = false;     // an error frame reported by the controller, never sent
  bool fd = false;        // CAN FD format (up to 64 bytes, no remote frames)
  bool bit_rate_switch = false;
  bool error_state_indicator = false;
  std::uint8_t length = 0;  // bytes used of `data`
  alignas(8) std::array<std::uint8_t, kCapacity> data{};
  std::int64_t stamp_ns = 0;  // receive time on the receiver's clock; 0 on frames being sent

  /// Same bits on the wire; the stamp is not compared.
  friend bool operator==(const CanFrame& a, const CanFrame& b) {
    if (a.id != b.id || a.extended != b.extended || a.remote != b.remote || a.error != b.error ||
        a.fd != b.fd || a.bit_rate_switch != b.bit_rate_switch || a.length != b.length) {
      return false;
    }
    for (std::size_t i = 0; i < a.length && i < kCapacity; ++i) {
      if (a.data[i] != b.data[i]) return false;
    }
    return true;
  }
};

}  // namespace hoof::hal
