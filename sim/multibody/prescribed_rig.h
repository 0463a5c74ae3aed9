// A foot moved along a given path, whatever the ground does: the paper's traction test.
#pragma once

#include <memory>

#include "sim/multibody/foot.h"
#include "sim/multibody/leg.h"
#include "sim/multibody/rig.h"

namespace hoof::sim {

/// Middle of the sole in the x-z plane of the leg.
struct FootPoint {
  double x_m = 0.0;
  double z_m = 0.0;
};

/// The middle segment follows the points given; its pitch is that of the shank of the leg, by the
/// leg's inverse kinematics. The toes still hang on their hinges and their drive.
class PrescribedRig final : public Rig {
 public:
  /// @throws std::invalid_argument where the leg cannot reach the start
  PrescribedRig(const Foot& foot, const Leg& leg, FootPoint start);
  ~PrescribedRig() override;

  /// Where the foot shall be at the end of the next step(). Without a new target it stands still.
  /// @throws std::invalid_argument where the leg cannot reach it
  void move_to(FootPoint target);

  int body_count() const override;
  const TriangleMesh& mesh(int body) const override;
  Pose pose(int body) const override;
  std::span<const Joint> joints() const override;
  double joint_position_rad(Joint joint) const override;
  double joint_velocity_rad_s(Joint joint) const override;
  void apply_joint_torque(Joint joint, double torque_Nm) override;
  void apply_wrench(int body, const Wrench& wrench) override;
  void step(double interval_s) override;
  RigEnergy energy() const override;
  Eigen::Vector3d foot_velocity_m_s() const override;
  double toe_opening_rad(int toe) const override;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace hoof::sim
