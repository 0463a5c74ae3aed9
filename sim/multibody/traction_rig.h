// A leg, its hip fixed in the world, drives a foot through the ground.
#pragma once

#include <memory>

#include "sim/multibody/foot.h"
#include "sim/multibody/leg.h"
#include "sim/multibody/rig.h"

namespace hoof::sim {

struct TractionRigSettings {
  Foot foot;
  Leg leg;
  /// Where the middle of the sole stands at the start, x forward of and z from the world origin
  /// (the hip is at x = 0, z = leg.hip_height_m).
  double start_x_m = 0.0;
  double start_z_m = 0.0;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;
};

/// Thigh and shank swing in the x-z plane; the middle segment of the foot is fixed to the shank,
/// the toes turn on their hinges. Gravity acts on all parts.
class TractionRig final : public Rig {
 public:
  explicit TractionRig(const TractionRigSettings& settings);
  ~TractionRig() override;

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
