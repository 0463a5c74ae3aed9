// One axis of a plan: picks the brake and the solver, and adds the brake's time to all durations.
#pragma once

#include "firmware/trajectory/axis_problem.h"
#include "firmware/trajectory/brake.h"
#include "firmware/trajectory/constant_axis.h"
#include "firmware/trajectory/jerk_axis.h"
#include "firmware/trajectory/profile.h"
#include "firmware/trajectory/result.h"
#include "firmware/trajectory/unlimited_jerk_axis.h"
#include "firmware/trajectory/velocity_axis.h"

namespace hoof::firmware::trajectory {

template <typename Real>
class Axis {
 public:
  void prepare(Interface interface, const AxisProblem<Real>& axis) {
    const AxisLimits<Real>& limits = axis.limits;
    const bool position = interface == Interface::kPosition;
    brake_ = {};
    at_target_ = position && axis.displacement == 0 && axis.velocity == axis.target_velocity &&
                 axis.acceleration == axis.target_acceleration;
    stays_ = false;
    if (limits.max_jerk == 0 || limits.max_acceleration == 0 || limits.min_acceleration == 0) {
      kind_ = Kind::kConstant;
      constant_.prepare(interface, axis);
    } else if (!is_finite(limits.max_jerk)) {
      kind_ = position ? Kind::kUnlimitedJerk : Kind::kUnlimitedJerkVelocity;
      if (position) {
        brake_ = unlimited_jerk_brake(axis.velocity, limits);
        unlimited_jerk_.prepare(after_brake(axis));
      } else {
        unlimited_jerk_velocity_.prepare(axis);
      }
    } else {
      kind_ = position ? Kind::kJerk : Kind::kVelocity;
      if (position) {
        brake_ = position_brake(axis.velocity, axis.acceleration, limits);
        jerk_.prepare(brake_.count > 0 ? after_brake(axis) : axis);
      } else {
        brake_ = velocity_brake(axis.velocity, axis.acceleration, limits);
        velocity_.prepare(brake_.count > 0 ? after_brake(axis) : axis);
      }
    }
  }

  // The first feasible duration >= from_s (equal to it when that one is feasible), or kNever.
  Real first_feasible(Real from_s) {
    // Nothing to do takes no time, even where holding still would first need a brake.
    stays_ = at_target_ && from_s == 0;
    if (stays_) return 0;
    const Real braking_s = brake_.total_s();
    const Real inner_from_s = positive_part(from_s - braking_s);
    const Real inner_s = first_feasible_after_brake(inner_from_s);
    if (inner_s < 0) return kNever<Real>;
    if (inner_s == inner_from_s && from_s >= braking_s) return from_s;
    return maximum(from_s, braking_s + inner_s);
  }

  // The motion for the duration that first_feasible() returned last.
  void motion(Mix<Real>& mix) const {
    if (stays_) {
      mix = {};
      return;
    }
    switch (kind_) {
      case Kind::kJerk:
        return jerk_.motion(mix);
      case Kind::kUnlimitedJerk:
        return unlimited_jerk_.motion(mix);
      case Kind::kVelocity:
        return velocity_.motion(mix);
      case Kind::kUnlimitedJerkVelocity:
        return unlimited_jerk_velocity_.motion(mix);
      case Kind::kConstant:
        return constant_.motion(mix);
    }
  }

  Brake<Real> brake() const { return stays_ ? Brake<Real>{} : brake_; }
  bool has_zero_limit() const { return kind_ == Kind::kConstant; }

 private:
  enum class Kind : unsigned char {
    kJerk,
    kUnlimitedJerk,
    kVelocity,
    kUnlimitedJerkVelocity,
    kConstant
  };

  Real first_feasible_after_brake(Real from_s) {
    switch (kind_) {
      case Kind::kJerk:
        return jerk_.first_feasible(from_s);
      case Kind::kUnlimitedJerk:
        return unlimited_jerk_.first_feasible(from_s);
      case Kind::kVelocity:
        return velocity_.first_feasible(from_s);
      case Kind::kUnlimitedJerkVelocity:
        return unlimited_jerk_velocity_.first_feasible(from_s);
      case Kind::kConstant:
        return constant_.first_feasible(from_s);
    }
    return kNever<Real>;
  }

  AxisProblem<Real> after_brake(AxisProblem<Real> axis) const {
    State<Real> state{0, axis.velocity, axis.acceleration};
    for (int i = 0; i < brake_.count; ++i) {
      const Phase<Real>& phase = brake_.phase[i];
      state.acceleration = phase.acceleration;
      state = Profile<Real>::advanced(state, phase.jerk, phase.duration_s);
    }
    axis.displacement -= state.position;
    axis.velocity = state.velocity;
    axis.acceleration = state.acceleration;
    return axis;
  }

  Kind kind_ = Kind::kConstant;
  Brake<Real> brake_;
  bool at_target_ = false;
  bool stays_ = false;  // the answer was a duration of 0
  JerkAxis<Real> jerk_;
  UnlimitedJerkAxis<Real> unlimited_jerk_;
  VelocityAxis<Real> velocity_;
  UnlimitedJerkVelocityAxis<Real> unlimited_jerk_velocity_;
  ConstantAxis<Real> constant_;
};

}  // namespace hoof::firmware::trajectory
