#include "sim/multibody/foot_rig.h"

#include <stdexcept>
#include <string>

namespace hoof::sim {

FootRig::FootRig(const Foot& foot, const MassProperties& carried, const Pose& pose,
                 const Eigen::Vector3d& gravity_m_s2)
    : foot_(foot), gravity_m_s2_(gravity_m_s2) {
  foot_.validate();
  world_ = std::make_unique<OdeWorld>(gravity_m_s2);

  double volume = volume_m3(foot_.middle);
  if (foot_.has_toes) volume += volume_m3(foot_.left_toe) + volume_m3(foot_.right_toe);
  const double density = foot_.mass_kg / volume;
  const MassProperties middle = solid(foot_.middle, density * volume_m3(foot_.middle));
  bodies_.reserve(3);
  bodies_.emplace_back(*world_, joined(middle, carried), pose);
  if (!foot_.has_toes) return;
  toes_.reserve(2);
  add_toe(foot_.left_toe, density * volume_m3(foot_.left_toe), 1.0);
  add_toe(foot_.right_toe, density * volume_m3(foot_.right_toe), -1.0);
  add_joint(Joint::kToe);
}

void FootRig::add_toe(const TriangleMesh& mesh, double mass_kg, double side) {
  const Pose middle = bodies_[0].pose();
  Eigen::Vector3d hinge_F = foot_.hinges.left_F_m;
  hinge_F.y() *= side;
  const Eigen::Vector3d hinge_W = middle.p_WB_m + middle.q_WB * hinge_F;
  // Outward is a turn about +z for the left toe, about -z for the right one.
  const Eigen::Vector3d axis_W = middle.q_WB * Eigen::Vector3d(0.0, 0.0, side);
  bodies_.emplace_back(*world_, solid(mesh, mass_kg), Pose{hinge_W, middle.q_WB});
  toes_.emplace_back(*world_, bodies_.back(), &bodies_[0], hinge_W, axis_W, 0.0);
  toes_.back().set_stops(foot_.hinges.min_opening_rad, foot_.hinges.max_opening_rad);
}

const TriangleMesh& FootRig::mesh(int body) const {
  const TriangleMesh* const meshes[] = {&foot_.middle, &foot_.left_toe, &foot_.right_toe};
  return *meshes[body];
}

double FootRig::joint_position_rad(Joint joint) const {
  if (joint == Joint::kToe && !toes_.empty()) {
    return 0.5 * (toes_[0].angle_rad() + toes_[1].angle_rad());
  }
  throw std::logic_error(std::string("this rig has no joint ") + joint_name(joint));
}

double FootRig::joint_velocity_rad_s(Joint joint) const {
  if (joint == Joint::kToe && !toes_.empty()) {
    return 0.5 * (toes_[0].rate_rad_s() + toes_[1].rate_rad_s());
  }
  throw std::logic_error(std::string("this rig has no joint ") + joint_name(joint));
}

void FootRig::apply_joint_torque(Joint joint, double torque_Nm) {
  if (joint != Joint::kToe || toes_.empty()) {
    throw std::logic_error(std::string("this rig has no joint ") + joint_name(joint));
  }
  for (OdeHinge& toe : toes_) toe.apply_torque(0.5 * torque_Nm);
}

void FootRig::apply_linkage() {
  const double difference = toes_[0].angle_rad() - toes_[1].angle_rad();
  const double rate = toes_[0].rate_rad_s() - toes_[1].rate_rad_s();
  const double torque_Nm = foot_.hinges.linkage_stiffness_Nm_rad * difference +
                           foot_.hinges.linkage_damping_Nm_s_rad * rate;
  toes_[0].apply_torque(-torque_Nm);
  toes_[1].apply_torque(torque_Nm);
}

void FootRig::step(double interval_s) {
  if (!toes_.empty()) apply_linkage();
  world_->step(interval_s);
}

double FootRig::moving_mass_kg() const {
  double mass_kg = 0.0;
  for (const OdeBody& body : bodies_) mass_kg += body.mass().mass_kg;
  return mass_kg;
}

double FootRig::gravity_J(const OdeBody& body) const {
  return -body.mass().mass_kg * gravity_m_s2_.dot(body.com_W_m());
}

RigEnergy FootRig::energy() const {
  RigEnergy energy;
  for (const OdeBody& body : bodies_) {
    energy.kinetic_J += body.kinetic_J();
    energy.gravity_J += gravity_J(body);
  }
  if (!toes_.empty()) {
    const double difference = toes_[0].angle_rad() - toes_[1].angle_rad();
    energy.linkage_J = 0.5 * foot_.hinges.linkage_stiffness_Nm_rad * difference * difference;
  }
  return energy;
}

}  // namespace hoof::sim
