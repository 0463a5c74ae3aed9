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
using control::seconds;
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
                              std::int64_t now_ns, std::uint32_t ticks) {
  const std::int64_t elapsed_ns = now_ns - inspected_ns_;
  inspected_ns_ = now_ns;
  const bool used = drives_are_used(mode);
  FaultBits found = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!presence_.has(i)) continue;
    found |= warm(i, joints[i], now_ns, elapsed_ns);
    if (!used) continue;
    if (!watching_) replies_[i].start(now_ns);
    found |=
        replies_[i].inspect(kLimits[i], kDrives[i], joints[i], verdict_.joint[i], now_ns, ticks);
  }
  watching_ = used;
  if (found != 0) latched_ = true;
  return found;
}

/// In every mode: a winding cools while its drive is off, and a drive that pushes then is worse. A
/// drive that has fallen silent, or whose commands have, drops its torque by its own time-out.
FaultBits TorqueGate::warm(std::size_t i, const JointState& state, std::int64_t now_ns,
                           std::int64_t elapsed_ns) {
  const bool fresh = state.received && now_ns - state.received_ns <= kFreshness_ns;
  const std::int64_t heated_ns = elapsed_ns < kFreshness_ns ? elapsed_ns : kFreshness_ns;
  heat_[i].add(fresh ? state.torque_Nm : 0.0f, seconds(heated_ns), seconds(elapsed_ns));
  return heat_[i].ratio() > kOverheated ? fault::kOverload : 0;
}

void TorqueGate::emergency_line(bool pressed) {
  pressed_ = pressed;
  if (pressed) emergency_stop();
}

bool TorqueGate::reset() {
  if (pressed_) return false;
  emergency_ = latched_ = false;
  return true;
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
    verdict_.faults = fault::kInvalidWish;
  }
  if (latched_ && !is_pure_damping(out.command)) {
    out.command = {.kd_Nm_s_rad = kLimits[i].stop_kd_Nm_s_rad};
    bits = limit::kLatched;
  }
  bits |= limit_targets(kLimits[i], state, out.command);
  const float ceiling_Nm = heat_ceiling_Nm(kDrives[i], heat_[i].ratio(), kLimits[i].torque_Nm);
  bits |= limit_torque(kLimits[i], ceiling_Nm, state, previous_Nm, out.command);
  verdict_.torque_Nm[i] = predicted_torque_Nm(out.command, state);
}

}  // namespace hoof::firmware::safety
