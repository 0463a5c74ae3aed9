// One axis with velocity target: reach a velocity and an acceleration; position follows. Units
// inside: extremal_side.h; without a jerk limit a constant acceleration does it.
#pragma once

#include "firmware/trajectory/axis_problem.h"
#include "firmware/trajectory/signal.h"
#include "firmware/trajectory/velocity_components.h"

namespace hoof::firmware::trajectory {

template <typename Real>
class VelocityAxis {
 public:
  void prepare(const AxisProblem<Real>& axis) {
    jerk_ = axis.limits.max_jerk;
    a0_ = axis.acceleration;
    af_ = axis.target_acceleration;
    high_ = axis.limits.max_acceleration;
    low_ = -axis.limits.min_acceleration;
    wd_ = (axis.target_velocity - axis.velocity) * jerk_;
    components_ = velocity_components(a0_, af_, wd_, high_, low_);
  }

  Real first_feasible(Real from_s) {
    const Real from = from_s * jerk_;
    for (int i = 0; i < components_.count; ++i) {
      const VelocityComponent<Real>& part = components_.part[i];
      if (from > part.end) continue;
      begins_part_ = from <= part.begin ? i : kNone;
      theta_ = maximum(from, part.begin);
      return begins_part_ == i ? maximum(from_s, part.begin / jerk_) : from_s;
    }
    return kNever<Real>;
  }

  void motion(Mix<Real>& mix) const {
    mix.upper.clear();
    mix.lower.clear();
    if (begins_part_ != kNone) {
      const VelocityComponent<Real>& part = components_.part[begins_part_];
      mix.weight = part.largest_gain ? Real(1) : Real(0);
      if (part.largest_gain) {
        append(part.extreme, part.hold, a0_, af_, jerk_, mix.upper);
      } else {
        append(part.extreme, part.hold, -a0_, -af_, -jerk_, mix.lower);
      }
      return;
    }
    const Real largest = gain(high_, a0_, af_, jerk_, mix.upper);
    const Real smallest = -gain(low_, -a0_, -af_, -jerk_, mix.lower);
    const Real range = largest - smallest;
    const Real weight = range > 0 ? (wd_ - smallest) / range : Real(1);
    mix.weight = minimum(positive_part(weight), Real(1));
  }

 private:
  void append(Real peak, Real hold, Real a0, Real af, Real jerk, Signal<Real>& signal) const {
    const Real sign = jerk > 0 ? Real(1) : Real(-1);
    signal.append((peak - a0) / jerk_, sign * a0, jerk);
    signal.append(hold / jerk_, sign * peak, 0);
    signal.append((peak - af) / jerk_, sign * peak, -jerk);
  }

  // Largest gain in theta_ as seen by an axis with peak `limit`; appends its signal.
  Real gain(Real limit, Real a0, Real af, Real jerk, Signal<Real>& signal) const {
    const Real peak = minimum((theta_ + a0 + af) / 2, limit);
    const Real hold = positive_part(theta_ - (peak - a0) - (peak - af));
    append(peak, hold, a0, af, jerk, signal);
    return peak * peak - (a0 * a0 + af * af) / 2 + limit * hold;
  }

  Real jerk_ = 1, a0_ = 0, af_ = 0, high_ = 0, low_ = 0, wd_ = 0;
  VelocityComponents<Real> components_{};
  static constexpr int kNone = -1;
  int begins_part_ = kNone;  // the answer was the start of this part
  Real theta_ = 0;
};

// Without a jerk limit.
template <typename Real>
class UnlimitedJerkVelocityAxis {
 public:
  void prepare(const AxisProblem<Real>& axis) {
    change_ = axis.target_velocity - axis.velocity;
    limit_ = change_ > 0 ? axis.limits.max_acceleration : axis.limits.min_acceleration;
  }

  Real first_feasible(Real from_s) {
    duration_s_ = maximum(from_s, change_ / limit_);
    return duration_s_;
  }

  void motion(Mix<Real>& mix) const {
    mix.upper.clear();
    mix.lower.clear();
    mix.weight = 1;
    mix.upper.append(duration_s_, change_ / duration_s_, 0);
  }

 private:
  Real change_ = 0, limit_ = 1, duration_s_ = 0;
};

}  // namespace hoof::firmware::trajectory
