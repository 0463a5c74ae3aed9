#include "sim/multibody/traction_rig.h"

#include <cmath>

namespace hoof::sim {
namespace {

/// Turns of the leg are positive forward: about -y.
const Eigen::Vector3d kForwardTurn = -Eigen::Vector3d::UnitY();

Eigen::Quaterniond forward_turn(double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, kForwardTurn));
}

Eigen::Vector3d hip_W_m(const Leg& leg) {
  return {0.0, 0.0, leg.hip_height_m};
}

/// A link hanging down from its joint at the origin. Gyration about the link's own length is taken
/// as that of a tube of a tenth of its length in diameter; it plays no part in plane motion.
MassProperties hanging(const Link& link) {
  const double across = link.mass_kg * link.gyration_m * link.gyration_m;
  const double radius_m = 0.05 * link.length_m;
  const double along = link.mass_kg * radius_m * radius_m;
  MassProperties mass{link.mass_kg, {0.0, 0.0, -link.com_from_joint_m}, Eigen::Matrix3d::Zero()};
  mass.inertia_kg_m2.diagonal() = Eigen::Vector3d(across, across, along);
  return mass;
}

/// The shank in the frame of the foot it is fixed to.
MassProperties shank_in_foot(const Leg& leg) {
  const LegAngles level = inverse_kinematics(leg, 0.0, leg.level_sole_z_m);
  const Eigen::Quaterniond q_FS = forward_turn(level.hip_rad + level.knee_rad);
  const Eigen::Vector3d knee_F_m = q_FS * Eigen::Vector3d(0.0, 0.0, leg.shank.length_m);
  MassProperties shank = hanging(leg.shank);
  const Eigen::Matrix3d rotation = q_FS.toRotationMatrix();
  shank.com_B_m = knee_F_m + rotation * shank.com_B_m;
  shank.inertia_kg_m2 = rotation * shank.inertia_kg_m2 * rotation.transpose();
  return shank;
}

Pose foot_pose(const Leg& leg, const LegAngles& angles) {
  const LegPoint foot = forward_kinematics(leg, angles);
  return {{foot.x_m, 0.0, foot.z_m}, forward_turn(foot.pitch_rad)};
}

Eigen::Vector3d knee_W_m(const Leg& leg, const LegAngles& angles) {
  return hip_W_m(leg) +
         forward_turn(angles.hip_rad) * Eigen::Vector3d(0.0, 0.0, -leg.thigh.length_m);
}

LegAngles start_angles(const TractionRigSettings& settings) {
  settings.validate();
  return inverse_kinematics(settings.leg, settings.start_x_m, settings.start_z_m);
}

}  // namespace

void TractionRigSettings::validate() const {
  foot.validate();
  leg.validate();
  inverse_kinematics(leg, start_x_m, start_z_m);
}

TractionRig::TractionRig(const TractionRigSettings& settings)
    : TractionRig(settings, start_angles(settings)) {}

TractionRig::TractionRig(const TractionRigSettings& settings, const LegAngles& start)
    : FootRig(settings.foot, shank_in_foot(settings.leg), foot_pose(settings.leg, start),
              {0.0, 0.0, -kGravity_m_s2}),
      thigh_(world(), hanging(settings.leg.thigh),
             {hip_W_m(settings.leg), forward_turn(start.hip_rad)}),
      hip_(world(), thigh_, nullptr, hip_W_m(settings.leg), kForwardTurn, start.hip_rad),
      knee_(world(), middle(), &thigh_, knee_W_m(settings.leg, start), kForwardTurn,
            start.knee_rad) {
  const Leg& leg = settings.leg;
  hip_.set_stops(leg.hip_min_rad, leg.hip_max_rad);
  knee_.set_stops(leg.knee_min_rad, leg.knee_max_rad);
  add_joint(Joint::kHip);
  add_joint(Joint::kKnee);
}

double TractionRig::joint_position_rad(Joint joint) const {
  if (joint == Joint::kHip) return hip_.angle_rad();
  if (joint == Joint::kKnee) return knee_.angle_rad();
  return FootRig::joint_position_rad(joint);
}

double TractionRig::joint_velocity_rad_s(Joint joint) const {
  if (joint == Joint::kHip) return hip_.rate_rad_s();
  if (joint == Joint::kKnee) return knee_.rate_rad_s();
  return FootRig::joint_velocity_rad_s(joint);
}

void TractionRig::apply_joint_torque(Joint joint, double torque_Nm) {
  if (joint == Joint::kHip) return hip_.apply_torque(torque_Nm);
  if (joint == Joint::kKnee) return knee_.apply_torque(torque_Nm);
  FootRig::apply_joint_torque(joint, torque_Nm);
}

RigEnergy TractionRig::energy() const {
  RigEnergy energy = FootRig::energy();
  energy.kinetic_J += thigh_.kinetic_J();
  energy.gravity_J += gravity_J(thigh_);
  return energy;
}

}  // namespace hoof::sim
