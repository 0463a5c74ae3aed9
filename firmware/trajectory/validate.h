// Refusal of bad input, naming the value, the joint and the bound it breaks.
#pragma once

#include <cstdint>
#include <limits>

#include "firmware/trajectory/input.h"

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

const char* name(Quantity quantity);
const char* name(Rule rule);

// The first broken rule, or an error that tests false. Start states outside the limits are not an
// error: the generator brakes first.
template <typename Real, int kMaxJoints>
ValidationError<Real> validate(const Input<Real, kMaxJoints>& input);

}  // namespace hoof::firmware::trajectory
