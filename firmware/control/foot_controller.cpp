#include "firmware/control/foot_controller.h"

namespace hoof::firmware::control {
namespace {

/// Faults after which the toe drive may have lost its count; one that restarts for want of supply
/// shows as lost torque first.
constexpr FaultBits kZeroDoubtful = fault::kDriveLost | fault::kDriveError |
                                    fault::kImplausibleReply | fault::kNotFollowing |
                                    fault::kHomingFailed | fault::kBrownOut;

LegAngles positions(const PerJoint<JointState>& joints) {
  return {joints[index(Joint::kHip)].position_rad, joints[index(Joint::kKnee)].position_rad};
}

}  // namespace

FootController::Parts::Parts(const Settings& settings, float period_s)
    : homing(settings.homing, period_s),
      toe(settings.toe, period_s),
      leg(settings, period_s),
      contact(settings.contact, leg.kinematics(), leg.dynamics()),
      adaptive(settings.adaptive, settings.toe.largest_angle_rad) {}

FootController::FootController(const Settings& settings, JointPresence presence, float period_s)
    : settings_(settings),
      presence_(presence),
      period_s_(period_s),
      parts_(std::in_place, settings, period_s),
      posture_(parts_->leg.kinematics().posture({})) {}

bool FootController::configure(const Settings& settings, JointPresence presence) {
  if (mode_ != Mode::kOff) return false;
  const bool same_zero = settings.homing == settings_.homing && presence.toe == presence_.toe;
  homed_ = homed_ && same_zero;
  settings_ = settings;
  presence_ = presence;
  parts_.emplace(settings_, period_s_);
  posture_ = parts_->leg.kinematics().posture(posture_.q);
  wish_all(DriveAction::kExit);
  return true;
}

// ---- orders ---------------------------------------------------------------------------------

Acceptance FootController::order_ready(float toe_angle_rad) {
  const Acceptance acceptance = accept(toe_angle_rad, 0.0f);
  if (acceptance != Acceptance::kAccepted) return acceptance;
  run_ordered_ = false;
  parts_->leg.set_frequency(0.0f);
  return acceptance;
}

Acceptance FootController::order_run(float toe_angle_rad, float frequency_Hz) {
  if (!presence_.leg) return Acceptance::kNoLeg;
  if (!(frequency_Hz > 0.0f)) return Acceptance::kOutOfRange;
  const Acceptance acceptance = accept(toe_angle_rad, frequency_Hz);
  if (acceptance != Acceptance::kAccepted) return acceptance;
  run_ordered_ = true;
  if (mode_ == Mode::kRunning) parts_->leg.set_frequency(frequency_Hz);
  return acceptance;
}

Acceptance FootController::accept(float toe_angle_rad, float frequency_Hz) {
  const bool in_range = toe_angle_rad >= 0.0f && toe_angle_rad <= settings_.toe.largest_angle_rad &&
                        frequency_Hz >= 0.0f && frequency_Hz <= settings_.path.largest_frequency_Hz;
  if (!in_range) return Acceptance::kOutOfRange;
  if (mode_ != Mode::kOff && !active()) return Acceptance::kWrongMode;
  if (!calibrated()) return Acceptance::kNotCalibrated;
  // A gait that only changes its frequency keeps what its toes have adapted to.
  const bool gait_goes_on = mode_ == Mode::kRunning && run_ordered_ && frequency_Hz > 0.0f;
  const bool same_toes = gait_goes_on && toe_angle_rad == toe_angle_rad_;
  toe_angle_rad_ = toe_angle_rad;
  frequency_Hz_ = frequency_Hz;
  if (mode_ == Mode::kOff) enter(Mode::kHoming);
  if (mode_ != Mode::kHoming && !same_toes) order_toe(toe_angle_rad);
  return Acceptance::kAccepted;
}

bool FootController::calibrated() const {
  const bool toe =
      !presence_.toe || !settings_.homing.is_absolute() || settings_.homing.is_calibrated();
  return toe && (!presence_.leg || settings_.leg.is_calibrated());
}

void FootController::order_toe(float toe_angle_rad) {
  parts_->toe.move_to(toe_angle_rad);
  parts_->adaptive.start(toe_angle_rad);
}

Acceptance FootController::order_stop() {
  if (mode_ == Mode::kEmergencyOff || mode_ == Mode::kFault) return Acceptance::kWrongMode;
  if (active()) enter(Mode::kDampedStop);
  return Acceptance::kAccepted;
}

Acceptance FootController::order_reset() {
  if (active() || mode_ == Mode::kDampedStop) return Acceptance::kWrongMode;
  faults_ = 0;
  enter(Mode::kOff);
  return Acceptance::kAccepted;
}

// ---- what others found ------------------------------------------------------------------------

void FootController::trip(FaultBits faults) {
  if (faults == 0) return;
  faults_ |= faults;
  if ((faults & kZeroDoubtful) != 0) homed_ = false;
  if (active()) enter(Mode::kDampedStop);
  if (mode_ == Mode::kOff) enter(Mode::kFault);
}

void FootController::emergency_stop() {
  faults_ |= fault::kEmergencyStop;
  enter(Mode::kEmergencyOff);
  wish_all(DriveAction::kExit);
}

// ---- modes ------------------------------------------------------------------------------------

bool FootController::active() const {
  return mode_ == Mode::kHoming || mode_ == Mode::kReady || mode_ == Mode::kRunning;
}

void FootController::enter(Mode mode) {
  mode_ = mode;
  mode_s_ = 0.0f;
  rest_s_ = 0.0f;
  drives_entered_ = false;
  wish_.mode = mode;
}

const Wish& FootController::step(const States& joints) {
  new_toe_zero_rad_.reset();
  parts_->leg.kinematics().update(posture_, positions(joints));
  if (presence_.toe && settings_.homing.is_absolute() && settings_.homing.is_calibrated()) {
    homed_ = homed_ || joints[index(Joint::kToe)].received;
  }
  wish_all(DriveAction::kExit);
  mode_s_ += period_s_;
  const Mode mode_before = mode_;
  switch (mode_) {
    case Mode::kHoming:
      step_homing(joints);
      break;
    case Mode::kReady:
      step_ready(joints);
      break;
    case Mode::kRunning:
      step_running(joints);
      break;
    case Mode::kDampedStop:
      step_damped_stop(joints);
      break;
    case Mode::kOff:
    case Mode::kEmergencyOff:
    case Mode::kFault:
      break;
  }
  // A fault found on the way: the stop begins in this very tick.
  if (mode_ != mode_before && mode_ == Mode::kDampedStop) step_damped_stop(joints);
  wish_.mode = mode_;
  return wish_;
}

void FootController::step_homing(const States& joints) {
  if (!drives_entered_) return enter_drives(joints);
  if (presence_.leg) command_leg(joints);
  if (homed()) return become_ready(joints);
  seek_toe_zero(joints);
}

/// The enter frame is repeated, so that one lost frame costs nothing.
void FootController::enter_drives(const States& joints) {
  constexpr float kEnterTime_s = 0.005f;
  wish_all(DriveAction::kEnter);
  bool all_answered = true;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    all_answered = all_answered && (joints[i].received || !presence_.has(i));
  }
  if (mode_s_ < kEnterTime_s || !all_answered) return;
  drives_entered_ = true;
  parts_->homing.start();
  parts_->leg.start(positions(joints));
  parts_->contact.reset();
}

void FootController::seek_toe_zero(const States& joints) {
  JointCommand seek;
  switch (parts_->homing.step(joints[index(Joint::kToe)], seek)) {
    case HomingResult::kSeeking:
      return command(Joint::kToe, seek);
    case HomingResult::kFailed:
      return trip(fault::kHomingFailed);
    case HomingResult::kFound:
      break;
  }
  homed_ = true;
  new_toe_zero_rad_ = parts_->homing.zero_rad();
  command(Joint::kToe, {.kd_Nm_s_rad = settings_.homing.kd_Nm_s_rad});
}

void FootController::become_ready(const States& joints) {
  const JointState& toe = joints[index(Joint::kToe)];
  parts_->toe.start(toe.position_rad);
  order_toe(toe_angle_rad_);
  parts_->leg.go_to_path();
  enter(Mode::kReady);
  step_ready(joints);
}

void FootController::step_ready(const States& joints) {
  command_toe(joints);
  command_leg(joints);
  const bool may_run = run_ordered_ && parts_->leg.on_path() && !parts_->toe.moving();
  if (!may_run || mode_ != Mode::kReady) return;
  parts_->leg.set_frequency(frequency_Hz_);
  enter(Mode::kRunning);
}

void FootController::step_running(const States& joints) {
  command_toe(joints);
  command_leg(joints);
  if (mode_ == Mode::kRunning) adapt_toe();
  if (mode_ == Mode::kRunning && !run_ordered_ && parts_->leg.at_rest()) enter(Mode::kReady);
}

void FootController::step_damped_stop(const States& joints) {
  bool at_rest = true;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const bool is_toe = i == index(Joint::kToe);
    const float kd = is_toe ? settings_.homing.kd_Nm_s_rad : settings_.leg.stop_kd_Nm_s_rad;
    command(static_cast<Joint>(i), {.kd_Nm_s_rad = kd});
    const bool slow = absolute(joints[i].velocity_rad_s) < settings_.stop.rest_speed_rad_s;
    at_rest = at_rest && (slow || !presence_.has(i));
  }
  rest_s_ = at_rest ? rest_s_ + period_s_ : 0.0f;
  if (rest_s_ < settings_.stop.rest_time_s && mode_s_ < settings_.stop.longest_s) return;
  enter(faults_ != 0 ? Mode::kFault : Mode::kOff);
  wish_all(DriveAction::kExit);
}

// ---- commands ---------------------------------------------------------------------------------

void FootController::command_toe(const States& joints) {
  if (!presence_.toe) return;
  const JointState& toe = joints[index(Joint::kToe)];
  command(Joint::kToe, parts_->toe.step(toe));
  if (parts_->toe.jammed()) trip(fault::kToeJammed);
  if (parts_->toe.stalled()) trip(fault::kToeStalled);
}

void FootController::command_leg(const States& joints) {
  if (!presence_.leg) return;
  const LegCommand leg = parts_->leg.step();
  command(Joint::kHip, leg.hip);
  command(Joint::kKnee, leg.knee);
  feel_ground(joints);
  if (!parts_->leg.reachable()) trip(fault::kPathUnreachable);
}

/// A drive holds its target for a tick while the joint moves on, so its torque falls by stiffness
/// times that way and jumps back with the next command. It replies when that command comes: what it
/// tells is the end of the fall, half of it below the mean. By default 7.5 Nm per rad/s, more than
/// all friction.
void FootController::feel_ground(const States& joints) {
  const JointState& hip = joints[index(Joint::kHip)];
  const JointState& knee = joints[index(Joint::kKnee)];
  const float half_fall_Nm_s_rad = 0.5f * period_s_ * settings_.leg.kp_Nm_rad;
  parts_->contact.update(posture_, {hip.velocity_rad_s, knee.velocity_rad_s},
                         parts_->leg.acceleration_rad_s2(),
                         {hip.torque_Nm + half_fall_Nm_s_rad * hip.velocity_rad_s,
                          knee.torque_Nm + half_fall_Nm_s_rad * knee.velocity_rad_s},
                         period_s_);
}

/// A step that meets the sand early, on a heap, ends at once.
void FootController::adapt_toe() {
  AdaptiveOpening& adaptive = parts_->adaptive;
  ToeOpening& toe = parts_->toe;
  if (!presence_.toe || !presence_.leg || !run_ordered_) return;
  if (!settings_.adaptive.is_enabled()) return;  // then it neither moves nor has moved
  const GroundEstimate& ground = parts_->contact.estimate();
  if (ground.contact && adaptive.moved()) toe.halt();
  const StancePath& path = parts_->leg.path();
  const bool may_move =
      !toe.moving() && path.above_sand_for(toe.longest_move_s(settings_.adaptive.largest_step_rad));
  const std::optional<float> angle_rad =
      adaptive.update(ground, path.below_sand(), may_move, toe.target_rad());
  if (angle_rad) toe.move_to(*angle_rad);
}

void FootController::command(Joint joint, const JointCommand& command) {
  if (!presence_.has(index(joint))) return;
  wish_.joint[index(joint)] = {DriveAction::kCommand, command};
}

void FootController::wish_all(DriveAction action) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    wish_.joint[i] = {presence_.has(i) ? action : DriveAction::kExit, {}};
  }
}

}  // namespace hoof::firmware::control
