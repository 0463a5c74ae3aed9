// A leg, its hip fixed in the world, drives a foot through the ground.
#pragma once

#include "sim/multibody/foot_rig.h"
#include "sim/multibody/leg.h"

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
class TractionRig final : public FootRig {
 public:
  explicit TractionRig(const TractionRigSettings& settings);

  double joint_position_rad(Joint joint) const override;
  double joint_velocity_rad_s(Joint joint) const override;
  void apply_joint_torque(Joint joint, double torque_Nm) override;
  RigEnergy energy() const override;

 private:
  TractionRig(const TractionRigSettings& settings, const LegAngles& start);

  OdeBody thigh_;
  OdeHinge hip_;
  OdeHinge knee_;
};

}  // namespace hoof::sim
