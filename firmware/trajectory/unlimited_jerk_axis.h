// One axis with position target and no jerk limit: the reachable-interval method of
// extremal_side.h with one integrator less. In the caller's units.
//
// The largest displacement in a time T belongs to a_max, [cruise at v_max], a_min. With the peak
// velocity vp:  p = (vp^2 - v0^2) / (2 a_max) + (vp^2 - vf^2) / (2 |a_min|),  dp/dT = vp.
#pragma once

#include "firmware/trajectory/axis_problem.h"
#include "firmware/trajectory/signal.h"

namespace hoof::firmware::trajectory {

namespace internal {

// The axis as seen upwards; mirrored for the smallest displacement.
template <typename Real>
struct UnlimitedJerkSide {
  Real v0, vf, v_max;
  Real high, low;  // a_max, |a_min|

  struct Shape {
    Real peak;
    Real cruise_s;
  };

  Real rise_s(const Shape& shape) const { return positive_part(shape.peak - v0) / high; }
  Real fall_s(const Shape& shape) const { return positive_part(shape.peak - vf) / low; }
  Real duration_s(const Shape& shape) const {
    return rise_s(shape) + shape.cruise_s + fall_s(shape);
  }
  Real displacement(const Shape& shape) const {
    return rise_s(shape) * (v0 + shape.peak) / 2 + fall_s(shape) * (vf + shape.peak) / 2 +
           shape.cruise_s * shape.peak;
  }
  Real displacement_rounding(const Shape& shape) const {
    const Real peak = magnitude(shape.peak);
    return kRounding<Real> * (rise_s(shape) * (magnitude(v0) + peak) +
                              fall_s(shape) * (magnitude(vf) + peak) + shape.cruise_s * peak);
  }

  Shape at_duration(Real t) const {
    Shape shape{v0 + high * (vf - v0 + low * t) / (high + low), 0};
    shape.peak = maximum(shape.peak, maximum(v0, vf));
    if (shape.peak > v_max) {
      shape.peak = maximum(v_max, maximum(v0, vf));
      shape.cruise_s = positive_part(t - duration_s(shape));
    }
    return shape;
  }

  // From a shape below `wanted`; displacement is convex in the duration, so there is one crossing.
  bool extend_to(Real wanted, Shape& shape) const {
    Shape end{maximum(v_max, shape.peak), 0};
    const Real beyond = wanted - displacement(end);
    if (beyond >= 0) {
      if (!(end.peak > 0)) return false;
      end.cruise_s = beyond / end.peak;
      shape = end;
      return true;
    }
    const Real growth = wanted - displacement(shape);
    const Real r = 2 * growth * high * low / (high + low);
    const Real sqrt_term = root(shape.peak * shape.peak + r);
    shape.peak += shape.peak > 0 ? r / (shape.peak + sqrt_term) : sqrt_term - shape.peak;
    return true;
  }
};

}  // namespace internal

template <typename Real>
class UnlimitedJerkAxis {
 public:
  void prepare(const AxisProblem<Real>& axis) {
    const AxisLimits<Real>& limits = axis.limits;
    wanted_ = axis.displacement;
    upper_ = {axis.velocity, axis.target_velocity, limits.max_velocity, limits.max_acceleration,
              -limits.min_acceleration};
    lower_ = {-axis.velocity, -axis.target_velocity, -limits.min_velocity, -limits.min_acceleration,
              limits.max_acceleration};
    const Real change = axis.target_velocity - axis.velocity;
    begin_s_ = change / (change > 0 ? limits.max_acceleration : limits.min_acceleration);
  }

  Real first_feasible(Real from_s) {
    const Real from = maximum(from_s, begin_s_);
    upper_shape_ = upper_.at_duration(from);
    lower_shape_ = lower_.at_duration(from);
    const Real above = upper_.displacement(upper_shape_) - wanted_;
    const Real below = lower_.displacement(lower_shape_) + wanted_;
    if (above < -upper_.displacement_rounding(upper_shape_)) {
      weight_ = 1;
      if (!upper_.extend_to(wanted_, upper_shape_)) return kNever<Real>;
      return maximum(from, upper_.duration_s(upper_shape_));
    }
    if (below < -lower_.displacement_rounding(lower_shape_)) {
      weight_ = 0;
      if (!lower_.extend_to(-wanted_, lower_shape_)) return kNever<Real>;
      return maximum(from, lower_.duration_s(lower_shape_));
    }
    weight_ = !(below > 0) ? Real(0) : !(above > 0) ? Real(1) : below / (above + below);
    return from;
  }

  void motion(Mix<Real>& mix) const {
    mix.weight = weight_;
    mix.upper.clear();
    mix.lower.clear();
    if (weight_ > 0) append(upper_, upper_shape_, 1, mix.upper);
    if (weight_ < 1) append(lower_, lower_shape_, -1, mix.lower);
  }

 private:
  using Side = internal::UnlimitedJerkSide<Real>;

  static void append(const Side& side, const typename Side::Shape& shape, Real sign,
                     Signal<Real>& signal) {
    signal.append(side.rise_s(shape), sign * side.high, 0);
    signal.append(shape.cruise_s, 0, 0);
    signal.append(side.fall_s(shape), -sign * side.low, 0);
  }

  Real wanted_ = 0, begin_s_ = 0;
  Side upper_{}, lower_{};
  typename Side::Shape upper_shape_{}, lower_shape_{};
  Real weight_ = 1;
};

}  // namespace hoof::firmware::trajectory
