// Nanoseconds to seconds, as control code reckons.
#pragma once

#include <cstdint>

namespace hoof::firmware::control {

/// The board's FPU converts 32 bits in one instruction; 64, more than two seconds, take a function
/// of the library's, which rounds the same way.
inline float seconds(std::int64_t time_ns) {
  const auto narrow = static_cast<std::int32_t>(time_ns);
  return (narrow == time_ns ? static_cast<float>(narrow) : static_cast<float>(time_ns)) * 1e-9f;
}

}  // namespace hoof::firmware::control
