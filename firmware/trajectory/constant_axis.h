// One axis whose jerk or acceleration limit is zero: its acceleration never changes, so its motion
// is given and only the duration is to be found, if any fits the target.
#pragma once

#include "firmware/trajectory/axis_problem.h"
#include "firmware/trajectory/result.h"
#include "firmware/trajectory/signal.h"

namespace hoof::firmware::trajectory {

template <typename Real>
class ConstantAxis {
 public:
  void prepare(Interface interface, const AxisProblem<Real>& axis) {
    acceleration_ = axis.acceleration;
    any_duration_ = false;
    only_s_ = kNever<Real>;
    const Real a = axis.acceleration;
    const Real v = axis.velocity;
    const bool position = interface == Interface::kPosition;
    const Real change = axis.target_velocity - v;
    if (a != axis.target_acceleration || a > axis.limits.max_acceleration ||
        a < axis.limits.min_acceleration) {
      return;
    }
    if (position && (v > axis.limits.max_velocity || v < axis.limits.min_velocity)) return;
    if (a != 0) {
      const Real t = change / a;
      const Real p = t * (v + axis.target_velocity) / 2;
      const Real rounding = kRounding<Real> * t * (magnitude(v) + magnitude(axis.target_velocity));
      if (t >= 0 && (!position || magnitude(p - axis.displacement) <= rounding)) only_s_ = t;
      return;
    }
    if (change != 0) return;
    if (!position || (v == 0 && axis.displacement == 0)) {
      any_duration_ = true;
    } else if (axis.displacement == 0) {
      only_s_ = 0;
    } else if (v != 0 && axis.displacement / v > 0) {
      only_s_ = axis.displacement / v;
    }
  }

  Real first_feasible(Real from_s) {
    duration_s_ = any_duration_ ? from_s : from_s <= only_s_ ? only_s_ : kNever<Real>;
    return duration_s_;
  }

  void motion(Mix<Real>& mix) const {
    mix.upper.clear();
    mix.lower.clear();
    mix.weight = 1;
    mix.upper.append(duration_s_, acceleration_, 0);
  }

 private:
  Real acceleration_ = 0;
  Real only_s_ = kNever<Real>;
  Real duration_s_ = 0;
  bool any_duration_ = false;
};

}  // namespace hoof::firmware::trajectory
