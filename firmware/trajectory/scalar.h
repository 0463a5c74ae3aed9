// The few scalar functions the solver needs, without libm and without a double in a float program.
#pragma once

#include <limits>

namespace hoof::firmware::trajectory {

template <typename Real>
inline constexpr Real kEpsilon = std::numeric_limits<Real>::epsilon();

template <typename Real>
inline constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

// Sums of a handful of products carry a few units of rounding; what is within this of a border is
// on the border.
template <typename Real>
inline constexpr Real kRounding = 16 * kEpsilon<Real>;

template <typename Real>
constexpr Real maximum(Real a, Real b) {
  return a < b ? b : a;
}

template <typename Real>
constexpr Real minimum(Real a, Real b) {
  return b < a ? b : a;
}

template <typename Real>
constexpr Real magnitude(Real a) {
  return a < 0 ? -a : a;
}

template <typename Real>
constexpr Real positive_part(Real a) {
  return a > 0 ? a : Real(0);
}

template <typename Real>
constexpr bool is_finite(Real a) {
  return magnitude(a) <= std::numeric_limits<Real>::max();  // false for NaN
}

// A square root is one instruction on the targets (built with -fno-math-errno). The argument is a
// quantity that cannot be negative but for rounding.
inline float root(float a) {
  return __builtin_sqrtf(positive_part(a));
}
inline double root(double a) {
  return __builtin_sqrt(positive_part(a));
}

}  // namespace hoof::firmware::trajectory
