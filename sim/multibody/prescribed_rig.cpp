#include "sim/multibody/prescribed_rig.h"

namespace hoof::sim {
namespace {

Pose foot_pose(const Leg& leg, const FootPoint& point) {
  const LegAngles angles = inverse_kinematics(leg, point.x_m, point.z_m);
  const double pitch = forward_kinematics(leg, angles).pitch_rad;
  return {{point.x_m, 0.0, point.z_m},
          Eigen::Quaterniond(Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()))};
}

}  // namespace

PrescribedRig::PrescribedRig(const Foot& foot, const Leg& leg, FootPoint start)
    : FootRig(foot, {}, foot_pose(leg, start), {0.0, 0.0, -kGravity_m_s2}),
      leg_(leg),
      target_(foot_pose(leg, start)) {
  middle().make_kinematic();
}

void PrescribedRig::move_to(FootPoint target) {
  target_ = foot_pose(leg_, target);
}

void PrescribedRig::step(double interval_s) {
  middle().move_kinematic(target_, interval_s);
  FootRig::step(interval_s);
}

RigEnergy PrescribedRig::energy() const {
  RigEnergy energy = FootRig::energy();
  // The middle is moved from outside: it has no energy of its own here.
  energy.kinetic_J -= middle().kinetic_J();
  energy.gravity_J -= gravity_J(middle());
  return energy;
}

}  // namespace hoof::sim
