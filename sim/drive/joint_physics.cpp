#include "sim/drive/joint_physics.h"

#include <algorithm>
#include <stdexcept>

namespace hoof::sim {

void JointPhysics::add(std::unique_ptr<JointEffect> effect, double torque_limit_Nm) {
  const unsigned stages = effect->stages();
  if (stages & kSupplyStage) {
    throw std::invalid_argument("a drive of the foot has no supply voltage in its model");
  }
  effect->reset(0, torque_limit_Nm);
  if (stages & kGoalStage) {
    goal_.push_back(effect.get());
    goal_delay_s_ += effect->goal_delay_s();
  }
  if (stages & kMotorStage) motor_.push_back(effect.get());
  if (stages & kFrictionStage) friction_.push_back(effect.get());
  if (stages & kLinkStage) link_.push_back(effect.get());
  if (stages & kSensorStage) sensor_.push_back(effect.get());
  if (stages & kGearStage) {
    half_gap_rad_ += 0.5 * effect->gap_rad();
    if (effect->stiffness_Nm_rad() > 0) {
      // Springs in a row.
      const double more = 1 / effect->stiffness_Nm_rad();
      stiffness_Nm_rad_ = 1 / (more + (stiffness_Nm_rad_ > 0 ? 1 / stiffness_Nm_rad_ : 0));
    }
  }
  owned_.push_back(std::move(effect));
}

bool JointPhysics::goal_lost() {
  bool lost = false;
  for (JointEffect* effect : goal_) lost = effect->goal_lost() || lost;
  return lost;
}

double JointPhysics::motor_torque_Nm(double torque_Nm, double velocity_rad_s, double dt_s) {
  for (JointEffect* effect : motor_) {
    torque_Nm = effect->motor_torque_Nm(torque_Nm, velocity_rad_s, dt_s);
  }
  return torque_Nm;
}

double JointPhysics::friction_Nm(const JointMotion& motion) const {
  double sum_Nm = 0;
  for (const JointEffect* effect : friction_) sum_Nm += effect->friction_Nm(motion);
  return sum_Nm;
}

double JointPhysics::link_torque_Nm(double q_rad, double w_rad_s, double time_s) {
  double sum_Nm = 0;
  for (JointEffect* effect : link_) sum_Nm += effect->link_torque_Nm(q_rad, w_rad_s, time_s);
  return sum_Nm;
}

double JointPhysics::reading_rad(double q_rad) const {
  for (const JointEffect* effect : sensor_) q_rad = effect->reading_rad(q_rad);
  return q_rad;
}

double JointPhysics::stiffness_Nm_rad(double gear_Nm_rad) const {
  return stiffness_Nm_rad_ > 0 ? std::min(stiffness_Nm_rad_, gear_Nm_rad) : gear_Nm_rad;
}

}  // namespace hoof::sim
