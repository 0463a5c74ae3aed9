// Refusal of bad input, naming the value, the joint and the bound it breaks.
#pragma once

#include <cstdint>

#include "firmware/trajectory/input.h"
#include "firmware/trajectory/scalar.h"

namespace hoof::firmware::trajectory {

enum class Quantity : std::uint8_t {
  kNone,
  kJoints,
  kPosition,
  kVelocity,
  kAcceleration,
  kTargetPosition,
  kTargetVelocity,
  kTargetAcceleration,
  kMaxVelocity,
  kMinVelocity,
  kMaxAcceleration,
  kMinAcceleration,
  kMaxJerk,
  kMinimumDuration,
  kDurationStep
};

enum class Rule : std::uint8_t {
  kValid,
  kFinite,   // must be a finite number
  kAtLeast,  // must be >= bound
  kAtMost,   // must be <= bound
  // The velocity at which the target's acceleration began (or would end) from zero,
  // v_f - a_f |a_f| / (2 j_max), must be >= / <= bound, or the target cannot be entered within the
  // velocity limits.
  kEntryAtLeast,
  kEntryAtMost
};

template <typename Real>
struct ValidationError {
  Rule rule = Rule::kValid;
  Quantity quantity = Quantity::kNone;
  int joint = -1;  // -1: not a per-joint value
  Real value = 0;
  Real bound = 0;

  explicit operator bool() const { return rule != Rule::kValid; }
};

namespace internal {

template <typename Real, int kMaxJoints>
class Validator {
 public:
  explicit Validator(const Input<Real, kMaxJoints>& input) : in_(input) {}

  ValidationError<Real> modes() {
    check(Quantity::kJoints, Real(in_.joints), Rule::kAtLeast, Real(1));
    check(Quantity::kJoints, Real(in_.joints), Rule::kAtMost, Real(kMaxJoints));
    non_negative(Quantity::kMinimumDuration, in_.minimum_duration_s);
    non_negative(Quantity::kDurationStep, in_.duration_step_s);
    return error_;
  }

  ValidationError<Real> joint(int i) {
    joint_ = i;
    const bool position = in_.interface == Interface::kPosition;
    finite(Quantity::kPosition, in_.position[i]);
    finite(Quantity::kVelocity, in_.velocity[i]);
    finite(Quantity::kAcceleration, in_.acceleration[i]);
    if (position) finite(Quantity::kTargetPosition, in_.target_position[i]);
    finite(Quantity::kTargetVelocity, in_.target_velocity[i]);
    finite(Quantity::kTargetAcceleration, in_.target_acceleration[i]);
    non_negative(Quantity::kMaxVelocity, in_.max_velocity[i]);
    non_positive(Quantity::kMinVelocity, in_.min_velocity[i]);
    non_negative(Quantity::kMaxAcceleration, in_.max_acceleration[i]);
    non_positive(Quantity::kMinAcceleration, in_.min_acceleration[i]);
    check(Quantity::kMaxJerk, in_.max_jerk[i], Rule::kAtLeast, Real(0));  // may be infinite
    check_target(position);
    return error_;
  }

 private:
  void check_target(bool position) {
    const int i = joint_;
    const Real af = in_.target_acceleration[i];
    check(Quantity::kTargetAcceleration, af, Rule::kAtMost, widened(in_.max_acceleration[i]));
    check(Quantity::kTargetAcceleration, af, Rule::kAtLeast, widened(in_.min_acceleration[i]));
    if (!position) return;
    const Real vf = in_.target_velocity[i];
    const Real v_max = widened(in_.max_velocity[i]);
    const Real v_min = widened(in_.min_velocity[i]);
    check(Quantity::kTargetVelocity, vf, Rule::kAtMost, v_max);
    check(Quantity::kTargetVelocity, vf, Rule::kAtLeast, v_min);
    if (!(in_.max_jerk[i] > 0)) return;
    const Real swing = af * af / (2 * in_.max_jerk[i]);
    const Real allowance = kRounding<Real> * swing;
    if (af < 0) {
      check(Quantity::kTargetVelocity, vf + swing, Rule::kEntryAtMost, v_max + allowance);
    } else {
      check(Quantity::kTargetVelocity, vf - swing, Rule::kEntryAtLeast, v_min - allowance);
    }
  }

  static Real widened(Real bound) { return bound * (1 + kRounding<Real>); }

  void finite(Quantity quantity, Real value) {
    if (!is_finite(value)) fail(quantity, value, Rule::kFinite, 0);
  }

  void non_negative(Quantity quantity, Real value) {
    finite(quantity, value);
    check(quantity, value, Rule::kAtLeast, Real(0));
  }

  void non_positive(Quantity quantity, Real value) {
    finite(quantity, value);
    check(quantity, value, Rule::kAtMost, Real(0));
  }

  // Written so that NaN fails.
  void check(Quantity quantity, Real value, Rule rule, Real bound) {
    const bool at_least = rule == Rule::kAtLeast || rule == Rule::kEntryAtLeast;
    if (!(at_least ? value >= bound : value <= bound)) fail(quantity, value, rule, bound);
  }

  void fail(Quantity quantity, Real value, Rule rule, Real bound) {
    if (error_) return;
    const bool per_joint = quantity != Quantity::kJoints &&
                           quantity != Quantity::kMinimumDuration &&
                           quantity != Quantity::kDurationStep;
    error_ = {rule, quantity, per_joint ? joint_ : -1, value, bound};
  }

  const Input<Real, kMaxJoints>& in_;
  int joint_ = 0;
  ValidationError<Real> error_;
};

}  // namespace internal

// The first broken rule among the values that belong to no joint, or an error that tests false.
template <typename Real, int kMaxJoints>
ValidationError<Real> validate_modes(const Input<Real, kMaxJoints>& input) {
  return internal::Validator<Real, kMaxJoints>(input).modes();
}

// The same among the values of one joint. Start states outside the limits are not an error: the
// generator brakes first.
template <typename Real, int kMaxJoints>
ValidationError<Real> validate_joint(const Input<Real, kMaxJoints>& input, int joint) {
  return internal::Validator<Real, kMaxJoints>(input).joint(joint);
}

template <typename Real, int kMaxJoints>
ValidationError<Real> validate(const Input<Real, kMaxJoints>& input) {
  ValidationError<Real> error = validate_modes(input);
  for (int i = 0; !error && i < input.joints; ++i) error = validate_joint(input, i);
  return error;
}

inline const char* name(Quantity quantity) {
  constexpr const char* kNames[] = {"none",
                                    "joints",
                                    "position",
                                    "velocity",
                                    "acceleration",
                                    "target_position",
                                    "target_velocity",
                                    "target_acceleration",
                                    "max_velocity",
                                    "min_velocity",
                                    "max_acceleration",
                                    "min_acceleration",
                                    "max_jerk",
                                    "minimum_duration_s",
                                    "duration_step_s"};
  return kNames[static_cast<int>(quantity)];
}

inline const char* name(Rule rule) {
  constexpr const char* kNames[] = {"valid",
                                    "must be finite",
                                    "must be at least",
                                    "must be at most",
                                    "less its acceleration swing must be at least",
                                    "plus its acceleration swing must be at most"};
  return kNames[static_cast<int>(rule)];
}

}  // namespace hoof::firmware::trajectory
