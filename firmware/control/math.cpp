#include "firmware/control/math.h"

namespace hoof::firmware::control {
namespace {

/// Taylor series; the first term left out is x^11/11! < 1.8e-9 for |x| <= pi/4.
float sin_series(float x) {
  const float z = x * x;
  return x + x * z * (-1.0f / 6 + z * (1.0f / 120 + z * (-1.0f / 5040 + z * (1.0f / 362880))));
}

/// Taylor series; the first term left out is x^10/10! < 2.5e-8 for |x| <= pi/4.
float cos_series(float x) {
  const float z = x * x;
  return 1.0f + z * (-0.5f + z * (1.0f / 24 + z * (-1.0f / 720 + z * (1.0f / 40320))));
}

/// Taylor series; the first term left out is x^17/17 < 1.9e-8 for |x| <= tan(pi/8).
float atan_series(float x) {
  const float z = x * x;
  float sum = -1.0f / 15;
  sum = 1.0f / 13 + z * sum;
  sum = -1.0f / 11 + z * sum;
  sum = 1.0f / 9 + z * sum;
  sum = -1.0f / 7 + z * sum;
  sum = 1.0f / 5 + z * sum;
  sum = -1.0f / 3 + z * sum;
  return x + x * z * sum;
}

/// For 0 <= x <= 1: atan x = pi/4 + atan((x - 1)/(x + 1)).
float atan_unit(float x) {
  constexpr float kTanPi8 = 0.414213562f;
  if (x <= kTanPi8) return atan_series(x);
  return kPi / 4 + atan_series((x - 1.0f) / (x + 1.0f));
}

}  // namespace

SinCos sin_cos(float angle_rad) {
  // pi/2 in three parts (Cody and Waite): the first two have so few bits that their products with a
  // small whole number are exact, which keeps the remainder exact.
  constexpr float kPart1 = 1.5703125f;
  constexpr float kPart2 = 4.83751297e-4f;
  constexpr float kPart3 = 7.54978995489e-8f;
  const float turns = angle_rad * (2.0f / kPi);
  const int quarter = static_cast<int>(turns < 0.0f ? turns - 0.5f : turns + 0.5f);
  const float n = static_cast<float>(quarter);
  const float r = ((angle_rad - n * kPart1) - n * kPart2) - n * kPart3;
  const float s = sin_series(r);
  const float c = cos_series(r);
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

float atan2(float y, float x) {
  const float ax = absolute(x);
  const float ay = absolute(y);
  if (ax == 0.0f && ay == 0.0f) return 0.0f;
  const float octant = ay <= ax ? atan_unit(ay / ax) : kHalfPi - atan_unit(ax / ay);
  const float half = x < 0.0f ? kPi - octant : octant;
  return y < 0.0f ? -half : half;
}

float acos(float x) {
  const float c = clamp(x, -1.0f, 1.0f);
  return atan2(square_root((1.0f - c) * (1.0f + c)), c);
}

}  // namespace hoof::firmware::control
