// A bracketed Newton iteration with a bounded number of steps.
#pragma once

#include "firmware/trajectory/scalar.h"

namespace hoof::firmware::trajectory {

template <typename Real>
struct ValueAndSlope {
  Real value;
  Real slope;
};

// The s in (0, high] with gain(s) = wanted, given gain(0) = 0 < wanted <= gain(high) and a single
// crossing. `gain` returns value and slope. The bracket makes it safe, Newton's step makes it
// fast (5 steps in the middle); 40 halvings exhaust a float, and leave 1e-12 of a double's bracket
// in the worst case, which needs a function no jerk-limited profile has.
template <typename Real, typename Gain>
Real solve_increment(const Gain& gain, Real wanted, Real high) {
  constexpr int kMaxSteps = 40;
  const Real close = kEpsilon<Real> > Real(1e-10) ? Real(3e-4) : Real(1e-8);  // about sqrt(epsilon)
  Real low = 0;
  const Real initial_slope = gain(Real(0)).slope;
  // A convex gain lies above its tangent at 0, so the tangent's root is an upper bound.
  Real s = initial_slope * high > wanted ? wanted / initial_slope : high;
  for (int step = 0; step < kMaxSteps; ++step) {
    const ValueAndSlope<Real> at = gain(s);
    const Real excess = at.value - wanted;
    if (excess > 0) {
      high = s;
    } else {
      low = s;
    }
    const Real next = s - excess / at.slope;
    if (!(next >= low && next <= high)) {
      s = low + (high - low) / 2;
      continue;
    }
    const Real change = magnitude(next - s);
    s = next;
    // Convergence is quadratic: after a step of sqrt(epsilon) the error is about epsilon.
    if (change <= close * next) break;
  }
  return s;
}

}  // namespace hoof::firmware::trajectory
