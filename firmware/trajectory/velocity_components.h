// Durations in which the end velocity and acceleration can be reached, whatever the position.
//
// Units and symbols of extremal_side.h. The velocity gains possible in theta with the accelerations
// fixed at both ends form an interval. Its upper end belongs to +1, [hold], -1 with the peak
// a_m = (theta + a0 + af) / 2 and is (2 a_m^2 - a0^2 - af^2) / 2; its lower end is the mirror
// image. At theta = |af - a0| both are the gain of the single ramp, (af + a0) |af - a0| / 2. From
// there the wanted gain wd comes within reach on one side, and is lost again (a blocked interval)
// only when both accelerations point one way: keeping to af then forces more gain than is wanted,
// until there is time to cross zero and come back.
#pragma once

#include "firmware/trajectory/scalar.h"

namespace hoof::firmware::trajectory {

// From `begin` to `end` in theta. At `begin` the profile is unique.
template <typename Real>
struct VelocityComponent {
  Real begin;
  Real end;
  bool largest_gain;  // the unique profile at begin is the largest gain, otherwise the smallest
  Real extreme;       // its peak (or the magnitude of its trough)
  Real hold;          // held there
};

template <typename Real>
struct VelocityComponents {
  VelocityComponent<Real> part[2];
  int count;
};

namespace internal {

// Ramp from a0 to an extreme of the given square, hold if that is beyond the limit, ramp to af;
// all three as seen by an axis whose extreme is positive.
template <typename Real>
VelocityComponent<Real> component_from(Real square, Real limit, Real a0, Real af, bool upward) {
  VelocityComponent<Real> part;
  part.largest_gain = upward;
  part.extreme = root(square);
  part.hold = 0;
  if (part.extreme > limit) {
    part.hold = (square - limit * limit) / limit;
    part.extreme = limit;
  }
  part.extreme = maximum(part.extreme, maximum(a0, af));
  part.begin = (part.extreme - a0) + (part.extreme - af) + part.hold;
  part.end = kInfinity<Real>;
  return part;
}

}  // namespace internal

template <typename Real>
VelocityComponents<Real> velocity_components(Real a0, Real af, Real wd, Real high, Real low) {
  const Real squares = (a0 * a0 + af * af) / 2;
  const Real ramp = magnitude(af - a0);
  const Real beyond_ramp = wd - ramp * (a0 + af) / 2;
  const Real rounding = kRounding<Real> * (magnitude(wd) + squares);
  VelocityComponents<Real> components;
  components.count = 1;
  VelocityComponent<Real>& first = components.part[0];

  const bool both_up = a0 > 0 && af > 0;
  const bool both_down = a0 < 0 && af < 0;
  if (magnitude(beyond_ramp) <= rounding) {
    // The single ramp does it; with both accelerations on one side there is no slack around it.
    first.begin = ramp;
    first.largest_gain = !both_down;
    first.extreme = both_down ? maximum(-a0, -af) : maximum(a0, af);
    first.hold = 0;
    first.end = both_up || both_down ? ramp : kInfinity<Real>;
    if (both_up) {
      components.part[1] = internal::component_from(squares - wd, low, -a0, -af, false);
      components.count = 2;
    } else if (both_down) {
      components.part[1] = internal::component_from(squares + wd, high, a0, af, true);
      components.count = 2;
    }
    return components;
  }
  if (beyond_ramp > 0) {
    first = internal::component_from(squares + wd, high, a0, af, true);
    if (both_up && wd < squares) {
      first.end = maximum(first.begin, a0 + af - 2 * root(squares - wd));
      components.part[1] = internal::component_from(squares - wd, low, -a0, -af, false);
      components.count = 2;
    }
  } else {
    first = internal::component_from(squares - wd, low, -a0, -af, false);
    if (both_down && -wd < squares) {
      first.end = maximum(first.begin, -a0 - af - 2 * root(squares + wd));
      components.part[1] = internal::component_from(squares + wd, high, a0, af, true);
      components.count = 2;
    }
  }
  return components;
}

}  // namespace hoof::firmware::trajectory
