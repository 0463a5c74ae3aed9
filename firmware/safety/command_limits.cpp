#include "firmware/safety/command_limits.h"

#include "firmware/control/math.h"

namespace hoof::firmware::safety {

using control::absolute;
using control::clamp;
using control::JointCommand;
using control::JointState;

namespace {

/// Puts `value` into the range; tells whether it was outside.
bool confine(float& value, float low, float high) {
  const float confined = clamp(value, low, high);
  const bool outside = confined != value;
  value = confined;
  return outside;
}

/// Reduces `gain * (target - measured)` towards zero by as much of delta as it can take.
void give_way(float gain, float measured, float& target, float& delta_Nm) {
  const float term = gain * (target - measured);
  if (term * delta_Nm >= 0.0f) return;  // 0 without a gain, or with nothing left to take
  const float kept = absolute(delta_Nm) >= absolute(term) ? 0.0f : term + delta_Nm;
  delta_Nm -= kept - term;
  target = measured + kept / gain;
}

}  // namespace

bool is_finite(const JointCommand& c) {
  return control::is_finite(c.position_rad) && control::is_finite(c.velocity_rad_s) &&
         control::is_finite(c.kp_Nm_rad) && control::is_finite(c.kd_Nm_s_rad) &&
         control::is_finite(c.torque_Nm);
}

bool is_pure_damping(const JointCommand& c) {
  return c.kp_Nm_rad == 0.0f && c.velocity_rad_s == 0.0f && c.torque_Nm == 0.0f;
}

LimitBits limit_targets(const JointLimits& limits, const JointState& state, JointCommand& c) {
  const bool kp_cut = confine(c.kp_Nm_rad, 0.0f, limits.kp_Nm_rad);
  const bool kd_cut = confine(c.kd_Nm_s_rad, 0.0f, limits.kd_Nm_s_rad);
  LimitBits bits = kp_cut || kd_cut ? limit::kGain : 0;
  if (confine(c.velocity_rad_s, -limits.velocity_rad_s, limits.velocity_rad_s)) {
    bits |= limit::kVelocity;
  }
  if (c.kp_Nm_rad == 0.0f) return bits;
  if (state.referenced && confine(c.position_rad, limits.lower_rad, limits.upper_rad)) {
    bits |= limit::kTravel;
  }
  if (confine(c.position_rad, state.position_rad - limits.distance_rad,
              state.position_rad + limits.distance_rad)) {
    bits |= limit::kDistance;
  }
  return bits;
}

LimitBits limit_torque(const JointLimits& limits, float ceiling_Nm, const JointState& state,
                       float previous_Nm, JointCommand& c) {
  const bool off_wire = confine(c.torque_Nm, -limits.feed_forward_Nm, limits.feed_forward_Nm);
  const float wished_Nm = predicted_torque_Nm(c, state);
  const float change_Nm = limits.torque_rate_Nm_s * control::kTick_s;
  float allowed_Nm = wished_Nm;
  const bool too_much = confine(allowed_Nm, -limits.torque_Nm, limits.torque_Nm);
  LimitBits bits = off_wire || too_much ? limit::kTorque : 0;
  if (confine(allowed_Nm, -ceiling_Nm, ceiling_Nm)) bits |= limit::kOverload;
  if (!is_pure_damping(c) &&
      confine(allowed_Nm, previous_Nm - change_Nm, previous_Nm + change_Nm)) {
    bits |= limit::kTorqueRate;
  }
  if (allowed_Nm == wished_Nm) return bits;
  if (is_pure_damping(c)) {
    // A torque that balances the damping at a speed the reply tells would push the joint where that
    // speed is wrong. Less damping never pushes.
    c.kd_Nm_s_rad *= allowed_Nm / wished_Nm;
  } else {
    shift_torque(limits, state, allowed_Nm - wished_Nm, c);
  }
  return bits;
}

void shift_torque(const JointLimits& limits, const JointState& state, float delta_Nm,
                  JointCommand& c) {
  const float before_Nm = c.torque_Nm;
  c.torque_Nm = clamp(before_Nm + delta_Nm, -limits.feed_forward_Nm, limits.feed_forward_Nm);
  delta_Nm -= c.torque_Nm - before_Nm;
  give_way(c.kp_Nm_rad, state.position_rad, c.position_rad, delta_Nm);
  give_way(c.kd_Nm_s_rad, state.velocity_rad_s, c.velocity_rad_s, delta_Nm);
}

}  // namespace hoof::firmware::safety
