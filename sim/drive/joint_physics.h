// The optional physics of one drive: the joint effects that act on it, asked stage by stage.
//
// Angles and torques at the joint side of the gear. What a stage means for a drive of the foot:
//   goals     The drive takes and answers every frame, but its law gets the goal late, or not at
//             all; enter, exit and zero are no goals.
//   motor     Between the torque that the law asks for, which is what the drive tells on the bus,
//             and the one that it makes. Heat is scaled with the drive's torque limit: a motor that
//             stands at its limit for long has T = 1.
//   friction  On the rotor. What the gear puts on it stands for gravity and springs.
//   gear      Play and spring between rotor and joint. A spring is never stiffer than the gear's
//             own, and damped by the gear's own share of critical.
//   link      On the joint, beside the gear's torque.
//   sensor    Between the rotor's angle and the counts of its encoder.
// A drive of the foot has no supply in its model: there is nothing for the supply stage.
#pragma once

#include <memory>
#include <vector>

#include "sim/effects/joint_effect.h"

namespace hoof::sim {

class JointPhysics {
 public:
  /// @throws std::invalid_argument for an effect that acts at the supply
  void add(std::unique_ptr<JointEffect> effect, double torque_limit_Nm);

  bool any() const { return !owned_.empty(); }
  bool rubs() const { return !friction_.empty(); }

  double goal_delay_s() const { return goal_delay_s_; }
  /// Once per goal.
  bool goal_lost();

  double motor_torque_Nm(double torque_Nm, double velocity_rad_s, double dt_s);
  /// Beside the drive's own; the sum of both may be below zero.
  double friction_Nm(const JointMotion& motion) const;
  double link_torque_Nm(double q_rad, double w_rad_s, double time_s);
  double reading_rad(double q_rad) const;

  double half_gap_rad() const { return half_gap_rad_; }
  /// Of the gear with its own stiffness `gear_Nm_rad`.
  double stiffness_Nm_rad(double gear_Nm_rad) const;

 private:
  std::vector<std::unique_ptr<JointEffect>> owned_;
  std::vector<JointEffect*> goal_, motor_, friction_, link_, sensor_;
  double goal_delay_s_ = 0;
  double half_gap_rad_ = 0;
  double stiffness_Nm_rad_ = 0;  // 0: the gear's own
};

}  // namespace hoof::sim
