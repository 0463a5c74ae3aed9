// What all rigs share: a foot as rigid bodies, its two toes on linked hinges.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sim/multibody/foot.h"
#include "sim/multibody/ode_world.h"
#include "sim/multibody/rig.h"

namespace hoof::sim {

/// The drive acts on the mean m of both openings: its torque does work on dm, so each toe gets half
/// of it. The linkage, a spring and damper on their difference, keeps the toes symmetric.
class FootRig : public Rig {
 public:
  int body_count() const override { return static_cast<int>(bodies_.size()); }
  const TriangleMesh& mesh(int body) const override;
  Pose pose(int body) const override { return bodies_[body].pose(); }
  std::span<const Joint> joints() const override { return joints_; }
  double joint_position_rad(Joint joint) const override;
  double joint_velocity_rad_s(Joint joint) const override;
  void apply_joint_torque(Joint joint, double torque_Nm) override;
  void apply_wrench(int body, const Wrench& wrench) override { bodies_[body].apply_wrench(wrench); }
  void step(double interval_s) override;
  RigEnergy energy() const override;
  Eigen::Vector3d foot_velocity_m_s() const override { return bodies_[0].velocity_m_s(); }
  double toe_opening_rad(int toe) const override { return toes_[toe].angle_rad(); }

 protected:
  /// @param carried mass fixed to the middle segment, in F
  FootRig(const Foot& foot, const MassProperties& carried, const Pose& pose,
          const Eigen::Vector3d& gravity_m_s2);

  OdeWorld& world() { return *world_; }
  OdeBody& middle() { return bodies_[0]; }
  const OdeBody& middle() const { return bodies_[0]; }
  const Foot& foot() const { return foot_; }
  double gravity_J(const OdeBody& body) const;
  /// Of the foot and what is fixed to it.
  double moving_mass_kg() const;
  void add_joint(Joint joint) { joints_.push_back(joint); }

 private:
  void add_toe(const TriangleMesh& mesh, double mass_kg, double side);
  void apply_linkage();

  Foot foot_;
  Eigen::Vector3d gravity_m_s2_;
  std::unique_ptr<OdeWorld> world_;
  /// Middle, left toe, right toe.
  std::vector<OdeBody> bodies_;
  std::vector<OdeHinge> toes_;
  std::vector<Joint> joints_;
};

}  // namespace hoof::sim
