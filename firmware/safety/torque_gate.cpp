#include "firmware/safety/torque_gate.h"

#include "firmware/control/math.h"
#include "firmware/safety/command_limits.h"

namespace hoof::firmware::safety {

using control::DriveAction;
using control::FaultBits;
using control::Joint;
using control::JointCommand;
using control::JointState;
using control::JointWish;
using control::kJointCount;
using control::Mode;
namespace fault = control::fault;

namespace {

bool drives_are_used(Mode mode) {
  return mode == Mode::kHoming || mode == Mode::kReady || mode == Mode::kRunning ||
         mode == Mode::kDampedStop;
}

/// The allow-list: what each mode may ask of a drive. Everything else is refused.
bool allowed(Mode mode, std::size_t joint, const JointWish& wish) {
  if (wish.action == DriveAction::kExit) return true;
  if (wish.action == DriveAction::kEnter) return mode == Mode::kHoming;
  const bool seeking_zero = joint == index(Joint::kToe) && wish.command.kp_Nm_rad == 0.0f;
  switch (mode) {
    case Mode::kHoming:
      return seeking_zero || joint != index(Joint::kToe);
    case Mode::kReady:
    case Mode::kRunning:
      return true;
    case Mode::kDampedStop:
      return is_pure_damping(wish.command);
    case Mode::kOff:
    case Mode::kEmergencyOff:
    case Mode::kFault:
      return false;
  }
  return false;
}

}  // namespace

FaultBits TorqueGate::inspect(const control::PerJoint<JointState>& joints, Mode mode,
                              std::int64_t now_ns) {
  if (!drives_are_used(mode)) {
    watching_ = false;
    return 0;
  }
  if (!watching_) {  // drives get the freshness time to answer for the first time
    watching_ = true;
    watched_since_ns_ = now_ns;
  }
  FaultBits found = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!presence_.has(i)) continue;
    found |= inspect_joint(i, joints[i], now_ns);
    last_[i] = joints[i];
  }
  if (found != 0) latched_ = true;
  return found;
}

FaultBits TorqueGate::inspect_joint(std::size_t i, const JointState& state, std::int64_t now_ns) {
  const bool heard = state.received && state.received_ns > watched_since_ns_;
  const std::int64_t heard_ns = heard ? state.received_ns : watched_since_ns_;
  if (now_ns - heard_ns > kFreshness_ns) return fault::kDriveLost;
  if (!heard) return 0;
  FaultBits found = 0;
  if (state.error != 0) found |= fault::kDriveError;
  if (state.temperature_C > kHighestTemperature_C) found |= fault::kOverTemperature;
  if (!position_plausible(i, state)) found |= fault::kImplausibleReply;
  const bool outside = state.position_rad < kLimits[i].lower_rad - kTravelMargin_rad ||
                       state.position_rad > kLimits[i].upper_rad + kTravelMargin_rad;
  if (state.referenced && outside) found |= fault::kOutsideTravel;
  return found;
}

bool TorqueGate::position_plausible(std::size_t i, const JointState& state) const {
  if (control::absolute(state.position_rad) >= kLimits[i].end_of_range_rad) return false;
  if (!last_[i].received || last_[i].received_ns == state.received_ns) return true;
  const float elapsed_s = static_cast<float>(state.received_ns - last_[i].received_ns) * 1e-9f;
  // Half a tick more: replies need not come at equal distances.
  const float reach_rad = kLimits[i].plausible_rad_s * (elapsed_s + 0.5f * control::kTick_s);
  return control::absolute(state.position_rad - last_[i].position_rad) <= reach_rad;
}

const Verdict& TorqueGate::check(const control::Wish& wish,
                                 const control::PerJoint<JointState>& joints) {
  verdict_.faults = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    verdict_.limits[i] = 0;
    if (presence_.has(i)) judge(i, wish.mode, wish.joint[i], joints[i]);
    if (verdict_.limits[i] != 0) ++interventions_;
  }
  return verdict_;
}

void TorqueGate::judge(std::size_t i, Mode mode, const JointWish& wish, const JointState& state) {
  JointWish& out = verdict_.joint[i];
  LimitBits& bits = verdict_.limits[i];
  const float previous_Nm = verdict_.torque_Nm[i];
  verdict_.torque_Nm[i] = 0.0f;
  out = wish;
  if (emergency_ && wish.action != DriveAction::kExit) {
    out = {};
    bits = limit::kLatched;
  } else if (!allowed(mode, i, wish) || (wish.action == DriveAction::kCommand && !state.received)) {
    out = {};
    bits = limit::kRefused;
  }
  if (out.action != DriveAction::kCommand) return;
  if (!is_finite(out.command)) {
    latched_ = true;
    verdict_.faults |= fault::kInvalidWish;
  }
  if (latched_ && !is_pure_damping(out.command)) {
    out.command = {.kd_Nm_s_rad = kLimits[i].stop_kd_Nm_s_rad};
    bits |= limit::kLatched;
  }
  bits |= limit_targets(kLimits[i], state, out.command);
  bits |= limit_torque(kLimits[i], state, previous_Nm, out.command);
  verdict_.torque_Nm[i] = predicted_torque_Nm(out.command, state);
}

}  // namespace hoof::firmware::safety
