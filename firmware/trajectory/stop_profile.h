// The fallback: bring one axis to standstill within its acceleration and jerk limits. A closed form
// that always exists, wherever the stop ends.
#pragma once

#include "firmware/trajectory/axis.h"

namespace hoof::firmware::trajectory {

template <typename Real>
void build_stop(const State<Real>& state, const AxisLimits<Real>& limits, Profile<Real>& profile) {
  Axis<Real> axis;
  axis.prepare(Interface::kVelocity, {0, state.velocity, state.acceleration, 0, 0, limits});
  const Real duration_s = axis.first_feasible(0);
  if (!(duration_s >= 0) || !is_finite(duration_s)) {
    // A zero limit forbids even the stop; standing still at once is what is left.
    profile.rest(state.position);
    return;
  }
  Mix<Real> mix;
  axis.motion(mix);
  profile.build(state, {}, axis.brake(), mix, 1, duration_s, Profile<Real>::End::kWhereItLeads);
}

}  // namespace hoof::firmware::trajectory
