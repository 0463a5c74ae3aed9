// Bringing a start state that is outside the limits, or bound to leave them, back inside.
//
// The minimum-time problem is not unique for such starts; the convention (that of the case files)
// is: first the acceleration goes to its bound at full jerk; if the velocity is, or will inevitably
// be, beyond its bound, full jerk towards the bound, holding the acceleration limit when it is
// reached, until the state is admissible. Only then the optimal profile begins.
#pragma once

#include "firmware/trajectory/axis_problem.h"
#include "firmware/trajectory/scalar.h"
#include "firmware/trajectory/signal.h"

namespace hoof::firmware::trajectory {

// At most two phases.
template <typename Real>
struct Brake {
  int count = 0;
  Phase<Real> phase[2] = {};

  Real total_s() const { return phase[0].duration_s + phase[1].duration_s; }
};

namespace internal {

// Works on the axis mirrored so that the state is to be pulled down; `sign` gives the values back
// their sign.
template <typename Real>
class JerkBrake {
 public:
  JerkBrake(Real velocity, Real acceleration, const AxisLimits<Real>& limits, bool mirrored)
      : sign_(mirrored ? Real(-1) : Real(1)),
        v_(velocity * sign_),
        a_(acceleration * sign_),
        v_max_(mirrored ? -limits.min_velocity : limits.max_velocity),
        v_min_(mirrored ? -limits.max_velocity : limits.min_velocity),
        a_max_(mirrored ? -limits.min_acceleration : limits.max_acceleration),
        a_min_(mirrored ? -limits.max_acceleration : limits.min_acceleration),
        jerk_(limits.max_jerk) {}

  bool acceleration_beyond() const { return a_ > a_max_ * (1 + kRounding<Real>); }

  // Velocity above its bound, or unavoidably so while the acceleration is taken away. Not when the
  // acceleration already down would carry it past the lower bound: that side comes first.
  bool velocity_beyond() const {
    const Real swing = a_ * a_ / (2 * jerk_);
    const Real bound = v_max_ + kRounding<Real> * (magnitude(v_max_) + swing);
    return (v_ > bound && v_ - swing > v_min_) || (a_ > 0 && v_ + swing > bound);
  }

  Brake<Real> pull_acceleration() const {
    const Real t_to_max = (a_ - a_max_) / jerk_;
    const Real v_at_max = v_ + t_to_max * (a_ + a_max_) / 2;
    if (v_ + a_ * a_ / (2 * jerk_) > v_max_) return pull_velocity();
    Real hold = 0;
    if (v_at_max < v_min_) {
      const Real until_inside = (v_min_ - v_at_max) / a_max_;
      const Real until_last_moment = (v_max_ - v_at_max) / a_max_ - a_max_ / (2 * jerk_);
      hold = positive_part(minimum(until_inside, until_last_moment));
    }
    return phases(t_to_max, hold, a_max_);
  }

  Brake<Real> pull_velocity() const {
    const Real t_to_min = (a_ - a_min_) / jerk_;
    // Jerk down until the velocity is back at its bound, or until the last moment from which the
    // lower bound is not overrun.
    const Real back = root(a_ * a_ + 2 * jerk_ * (v_ - v_max_));
    const Real last_moment = root(a_ * a_ / 2 + jerk_ * (v_ - v_min_));
    const Real t = (a_ + minimum(back, last_moment)) / jerk_;
    if (t <= t_to_min) return phases(t, 0, 0);
    const Real v_at_min = v_ + t_to_min * (a_ + a_min_) / 2;
    const Real hold_back = (v_max_ - v_at_min) / a_min_;
    const Real hold_last_moment = (v_min_ - v_at_min) / a_min_ + a_min_ / (2 * jerk_);
    return phases(positive_part(t_to_min), positive_part(minimum(hold_back, hold_last_moment)),
                  a_min_);
  }

  Brake<Real> pull_acceleration_only() const { return phases((a_ - a_max_) / jerk_, 0, 0); }

 private:
  Brake<Real> phases(Real ramp_s, Real hold_s, Real held) const {
    Brake<Real> brake;
    brake.count = hold_s > 0 ? 2 : 1;
    brake.phase[0] = {positive_part(ramp_s), sign_ * a_, -sign_ * jerk_};
    brake.phase[1] = {hold_s, sign_ * held, 0};
    return brake;
  }

  Real sign_, v_, a_, v_max_, v_min_, a_max_, a_min_, jerk_;
};

}  // namespace internal

template <typename Real>
Brake<Real> position_brake(Real velocity, Real acceleration, const AxisLimits<Real>& limits) {
  const internal::JerkBrake<Real> down(velocity, acceleration, limits, false);
  const internal::JerkBrake<Real> up(velocity, acceleration, limits, true);
  if (down.acceleration_beyond()) return down.pull_acceleration();
  if (up.acceleration_beyond()) return up.pull_acceleration();
  if (down.velocity_beyond()) return down.pull_velocity();
  if (up.velocity_beyond()) return up.pull_velocity();
  return {};
}

// With a velocity target only the acceleration has limits.
template <typename Real>
Brake<Real> velocity_brake(Real velocity, Real acceleration, const AxisLimits<Real>& limits) {
  const internal::JerkBrake<Real> down(velocity, acceleration, limits, false);
  const internal::JerkBrake<Real> up(velocity, acceleration, limits, true);
  if (down.acceleration_beyond()) return down.pull_acceleration_only();
  if (up.acceleration_beyond()) return up.pull_acceleration_only();
  return {};
}

// Without a jerk limit: full deceleration until the velocity is at its bound.
template <typename Real>
Brake<Real> unlimited_jerk_brake(Real velocity, const AxisLimits<Real>& limits) {
  Brake<Real> brake;
  if (velocity > limits.max_velocity) {
    brake.phase[0] = {(limits.max_velocity - velocity) / limits.min_acceleration,
                      limits.min_acceleration, 0};
  } else if (velocity < limits.min_velocity) {
    brake.phase[0] = {(limits.min_velocity - velocity) / limits.max_acceleration,
                      limits.max_acceleration, 0};
  } else {
    return brake;
  }
  brake.count = 1;
  return brake;
}

}  // namespace hoof::firmware::trajectory
