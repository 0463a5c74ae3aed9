// Elementary functions for control code: the same bits on host, emulated image and board, which the
// C library does not promise. Error bounds are tested against the C library in double precision.
#pragma once

#include <cstdint>

namespace hoof::firmware::control {

inline constexpr float kPi = 3.14159265358979f;
inline constexpr float kTwoPi = 6.28318530717959f;
inline constexpr float kHalfPi = 1.57079632679490f;
inline constexpr float kGravity_m_s2 = 9.80665f;  // standard gravity, ISO 80000-3

inline float square_root(float x) {
  return __builtin_sqrtf(x);
}  // one instruction on the board
inline float absolute(float x) {
  return x < 0.0f ? -x : x;
}
inline float clamp(float x, float low, float high) {
  return x < low ? low : x > high ? high : x;
}
inline float square(float x) {
  return x * x;
}

/// Nanoseconds to seconds. The board's FPU converts 32 bits in one instruction; 64, more than two
/// seconds, take a function of the library's, which rounds the same way.
inline float seconds(std::int64_t time_ns) {
  const auto narrow = static_cast<std::int32_t>(time_ns);
  return (narrow == time_ns ? static_cast<float>(narrow) : static_cast<float>(time_ns)) * 1e-9f;
}

/// False for not-a-number and infinities.
inline bool is_finite(float x) {
  return x - x == 0.0f;
}

struct SinCos {
  float sin;
  float cos;
};

/// Absolute error below 1.5e-7 for |angle| <= 100 rad; not meant for more.
SinCos sin_cos(float angle_rad);

/// Angle of the point (x, y), -pi to pi; 0 at the origin. Error below 4e-7 rad.
float atan2(float y, float x);

/// 0 to pi; arguments beyond -1 and 1 count as those. Error below 4e-7 rad.
float acos(float x);

}  // namespace hoof::firmware::control
