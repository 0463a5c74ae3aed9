#include "firmware/control/leg_motion.h"

namespace hoof::firmware::control {

LegMotion::LegMotion(const Settings& settings, float period_s)
    : settings_(settings.leg),
      period_s_(period_s),
      kinematics_(settings.leg_model.thigh_m, settings.leg_model.shank_m),
      dynamics_(settings.leg_model),
      path_(settings.path),
      level_shank_rad_(
          LegKinematics::shank_angle_rad(kinematics_.angles(path_.deepest_m()).angles)),
      generator_(period_s),
      set_point_(kinematics_.posture(position_)) {
  for (int joint = 0; joint < 2; ++joint) {
    input_.set_limits(joint, settings_.speed_rad_s, settings_.acceleration_rad_s2,
                      settings_.jerk_rad_s3);
  }
  generator_.set_work_per_update(kPlanningUnitsPerTick);
}

void LegMotion::start(LegAngles measured) {
  stage_ = Stage::kHold;
  reachable_ = true;
  position_ = measured;
  velocity_ = {};
  acceleration_ = {};
  kinematics_.update(set_point_, position_);
  path_.reset();
}

void LegMotion::go_to_path() {
  const LegInverse goal = kinematics_.angles(path_.point().position_m);
  reachable_ = goal.reachable;
  generator_.reset();
  input_.position = {position_.hip_rad, position_.knee_rad};
  input_.target_position = {goal.angles.hip_rad, goal.angles.knee_rad};
  stage_ = Stage::kMove;
}

LegCommand LegMotion::step() {
  if (stage_ == Stage::kMove) advance_move();
  if (stage_ == Stage::kPath) advance_path();
  kinematics_.update(set_point_, position_);
  const LegAngles torque = dynamics_.torque_Nm(set_point_.sines, velocity_, acceleration_);
  return {command(position_.hip_rad, velocity_.hip_rad, torque.hip_rad),
          command(position_.knee_rad, velocity_.knee_rad, torque.knee_rad)};
}

void LegMotion::advance_move() {
  const trajectory::Result result = generator_.update(input_, move_);
  if (trajectory::is_failure(result)) reachable_ = false;
  position_ = {move_.position[0], move_.position[1]};
  velocity_ = {move_.velocity[0], move_.velocity[1]};
  acceleration_ = {move_.acceleration[0], move_.acceleration[1]};
  const bool arrived =
      result == trajectory::Result::kFinished || result == trajectory::Result::kHolding;
  if (arrived) stage_ = Stage::kPath;
}

void LegMotion::advance_path() {
  path_.advance(period_s_);
  const PathPoint point = path_.point();
  const LegInverse inverse = kinematics_.angles(point.position_m);
  reachable_ = reachable_ && inverse.reachable;
  position_ = inverse.angles;
  kinematics_.update(set_point_, position_);
  velocity_ = kinematics_.joint_velocity_rad_s(set_point_, point.velocity_m_s);
  acceleration_ =
      kinematics_.joint_acceleration_rad_s2(set_point_, velocity_, point.acceleration_m_s2);
}

JointCommand LegMotion::command(float position, float velocity, float torque) const {
  return {position, velocity, settings_.kp_Nm_rad, settings_.kd_Nm_s_rad, torque};
}

}  // namespace hoof::firmware::control
