// One axis with position target and limited jerk: which durations it can take, and its motion for
// a given one. Start and target are inside the limits (the brake has seen to it). Units inside:
// extremal_side.h.
#pragma once

#include "firmware/trajectory/axis_problem.h"
#include "firmware/trajectory/extremal_side.h"
#include "firmware/trajectory/signal.h"
#include "firmware/trajectory/velocity_components.h"

namespace hoof::firmware::trajectory {

template <typename Real>
class JerkAxis {
 public:
  void prepare(const AxisProblem<Real>& axis) {
    const Real jerk = axis.limits.max_jerk;
    jerk_ = jerk;
    inverse_jerk_ = 1 / jerk;
    wanted_ = axis.displacement * jerk * jerk;
    const Real a0 = axis.acceleration;
    const Real af = axis.target_acceleration;
    const Real w0 = axis.velocity * jerk;
    const Real wf = axis.target_velocity * jerk;
    const Real wd = (axis.target_velocity - axis.velocity) * jerk;
    const Real high = axis.limits.max_acceleration;
    const Real low = -axis.limits.min_acceleration;
    upper_ = ExtremalSide<Real>({a0, af, w0, wf, wd, high, low, axis.limits.max_velocity * jerk});
    lower_ =
        ExtremalSide<Real>({-a0, -af, -w0, -wf, -wd, low, high, -axis.limits.min_velocity * jerk});
    components_ = velocity_components(a0, af, wd, high, low);
  }

  // The first feasible duration >= from_s, or kNever.
  Real first_feasible(Real from_s) {
    const Real from = from_s * jerk_;
    for (int i = 0; i < components_.count; ++i) {
      const VelocityComponent<Real>& part = components_.part[i];
      const bool ends_in_gap = i + 1 < components_.count;
      if (ends_in_gap && from > part.end * (1 + kRounding<Real>)) continue;
      const Outcome outcome =
          from <= part.begin ? from_begin(part, ends_in_gap) : from_inside(from, ends_in_gap);
      switch (outcome) {
        case Outcome::kHere:
          return from <= part.begin ? part.begin * inverse_jerk_ : from_s;
        case Outcome::kUpper:
          return maximum(from_s, upper_.duration(upper_shape_) * inverse_jerk_);
        case Outcome::kLower:
          return maximum(from_s, lower_.duration(lower_shape_) * inverse_jerk_);
        case Outcome::kNone:
          break;
      }
    }
    return kNever<Real>;
  }

  // The motion for the duration that first_feasible() returned last.
  void motion(Mix<Real>& mix) const {
    mix.weight = weight_;
    mix.upper.clear();
    mix.lower.clear();
    if (weight_ > 0) append(upper_, upper_shape_, jerk_, mix.upper);
    if (weight_ < 1) append(lower_, lower_shape_, -jerk_, mix.lower);
  }

 private:
  enum class Outcome { kHere, kUpper, kLower, kNone };

  static Shape<Real> begin_shape(const ExtremalSide<Real>& side,
                                 const VelocityComponent<Real>& part, bool mirrored) {
    return part.largest_gain != mirrored ? side.largest_gain(part.extreme, part.hold)
                                         : side.smallest_gain(part.extreme, part.hold);
  }

  Outcome from_begin(const VelocityComponent<Real>& part, bool ends_in_gap) {
    upper_shape_ = begin_shape(upper_, part, false);
    const Real displacement = upper_.displacement(upper_shape_);
    const Real missing = wanted_ - displacement;
    if (magnitude(missing) <= upper_.displacement_rounding(upper_shape_)) {
      weight_ = 1;
      return Outcome::kHere;
    }
    if (missing > 0) return extend_upper(ends_in_gap);
    lower_shape_ = begin_shape(lower_, part, true);
    return extend_lower(ends_in_gap);
  }

  Outcome from_inside(Real from, bool ends_in_gap) {
    upper_shape_ = upper_.at_duration(from);
    const Real above = upper_.displacement(upper_shape_) - wanted_;
    if (above < -upper_.displacement_rounding(upper_shape_)) return extend_upper(ends_in_gap);
    lower_shape_ = lower_.at_duration(from);
    const Real below = lower_.displacement(lower_shape_) + wanted_;  // mirrored: -p_min
    if (below < -lower_.displacement_rounding(lower_shape_)) return extend_lower(ends_in_gap);
    weight_ = !(below > 0) ? Real(0) : !(above > 0) ? Real(1) : below / (above + below);
    return Outcome::kHere;
  }

  Outcome extend_upper(bool ends_in_gap) {
    weight_ = 1;
    return upper_.extend_to(wanted_, ends_in_gap, upper_shape_) ? Outcome::kUpper : Outcome::kNone;
  }

  Outcome extend_lower(bool ends_in_gap) {
    weight_ = 0;
    return lower_.extend_to(-wanted_, ends_in_gap, lower_shape_) ? Outcome::kLower : Outcome::kNone;
  }

  void append(const ExtremalSide<Real>& side, const Shape<Real>& shape, Real jerk,
              Signal<Real>& signal) const {
    const Real sign = jerk > 0 ? Real(1) : Real(-1);
    const auto phase = [&](Real theta, Real acceleration, Real of_jerk) {
      signal.append(theta * inverse_jerk_, sign * acceleration, of_jerk);
    };
    phase(shape.ap - side.a0(), side.a0(), jerk);
    phase(shape.hold_high, shape.ap, 0);
    if (shape.cruises) {
      phase(shape.ap, shape.ap, -jerk);
      phase(shape.cruise, 0, 0);
      phase(-shape.aq, 0, -jerk);
    } else {
      phase(shape.ap - shape.aq, shape.ap, -jerk);
    }
    phase(shape.hold_low, shape.aq, 0);
    phase(side.af() - shape.aq, shape.aq, jerk);
  }

  Real jerk_ = 1, inverse_jerk_ = 1;
  Real wanted_ = 0;  // J^2 times the displacement
  ExtremalSide<Real> upper_, lower_;
  VelocityComponents<Real> components_{};
  Shape<Real> upper_shape_, lower_shape_;
  Real weight_ = 1;
};

}  // namespace hoof::firmware::trajectory
