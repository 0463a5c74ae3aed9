// A bracketed root finder with a bounded number of steps.
#pragma once

#include "firmware/trajectory/scalar.h"

namespace hoof::firmware::trajectory {

template <typename Real>
struct ValueAndSlope {
  Real value;
  Real slope;
};

// Steps after which the search ends wherever it is: what the time of one unit of planning is bounded
// by. Never needed: tests/firmware/trajectory/increment_solver_test.cpp counts.
template <typename Real>
inline constexpr int kMostSolverSteps = kEpsilon<Real> > Real(1e-10) ? 14 : 20;

namespace internal {

// ratio^(1 / degree), about: what `s` is to be multiplied by when the gain there is to be
// multiplied by `ratio` and grows like s^degree. Degree 3 is off by ratio^(1/48).
template <typename Real>
Real power_step(Real ratio, Real degree) {
  const Real half = root(ratio);
  if (degree < Real(2.5)) return half;
  const Real quarter = root(half);
  if (degree > Real(3.5)) return quarter;
  return quarter * root(root(quarter));
}

}  // namespace internal

// The s in (0, high] with gain(s) = wanted, given gain(0) = 0 < wanted <= gain(high) and a single
// crossing; `gain` returns value and slope. Newton's step while it makes headway, else the middle
// of the bracket. Far above the root, where Newton would creep (a factor 2/3 a step where the gain
// grows like s^3), a step that is right for the power of s the gain grows with there.
template <typename Real, typename Gain>
Real solve_increment(const Gain& gain, Real wanted, Real high) {
  // Convergence is quadratic: after a step of sqrt(epsilon) the error is about epsilon.
  const Real close = kEpsilon<Real> > Real(1e-10) ? Real(3e-4) : Real(1e-8);
  const Real far = 8 * wanted;
  Real low = 0;
  bool high_known = false;
  const Real initial_slope = gain(Real(0)).slope;
  // A convex gain lies above its tangent at 0, so the tangent's root is an upper bound.
  Real s = initial_slope * high > wanted ? wanted / initial_slope : high;
  Real last_change = high;
  Real change_before = high;
  for (int step = 0; step < kMostSolverSteps<Real>; ++step) {
    const ValueAndSlope<Real> at = gain(s);
    const Real excess = at.value - wanted;
    if (excess > 0) {
      high = s;
      high_known = true;
    } else {
      low = s;
      if (!(excess < 0) || !(s < high)) return s;
    }
    Real next;
    if (low == 0 && at.value > far && s * at.slope > Real(1.5) * at.value) {
      next = s * internal::power_step(wanted / at.value, s * at.slope / at.value);
    } else {
      next = s - excess / at.slope;
      // Rounding may carry a root at the very end of the bracket past it.
      if (next > high && !high_known) next = high;
      const bool headway = magnitude(next - s) * 2 <= change_before;
      if (!(next >= low && next <= high && headway)) {
        next = high > 4 * low ? root(low) * root(high) : low + (high - low) / 2;
        if (low == 0) next = high / 2;
      } else if (magnitude(next - s) <= close * next) {
        return next;
      }
    }
    if (high - low <= 2 * kEpsilon<Real> * high) return next;
    change_before = last_change;
    last_change = magnitude(next - s);
    s = next;
  }
  return s;
}

}  // namespace hoof::firmware::trajectory
