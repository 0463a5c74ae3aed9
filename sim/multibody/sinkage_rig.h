// A carriage on a vertical slider presses a foot into the ground.
#pragma once

#include <memory>

#include "sim/multibody/foot.h"
#include "sim/multibody/rig.h"

namespace hoof::sim {

/// How the load acts once the carriage is released.
enum class LoadAs {
  /// Constant force on the light foot: the moving mass is that of the foot alone. The paper's
  /// depths
  /// at 0.1 to 0.4 m/s fit this with a foot of 1.1-2.1 kg (2.4-5.7 % rms); a mass block of 10-60 kg
  /// over-predicts the effect of speed (17-21 %). Hence the default.
  kForce,
  /// The load is a block on the carriage: moving mass and weight both belong to the load.
  kMass,
};

struct SinkageRigSettings {
  Foot foot;
  /// Vertical force on the ground at rest. Weight of the foot is part of it: the world has no
  /// gravity of its own and this force is all that pulls the carriage down, so that the ground
  /// carries exactly the load of the test's name.
  double load_N = 0.0;
  LoadAs load_as = LoadAs::kForce;
  /// Sole above the world origin at the start.
  double start_height_m = 0.0;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;
};

/// Only vertical motion; the middle segment is fixed to the carriage and level. No hip, no knee.
class SinkageRig final : public Rig {
 public:
  explicit SinkageRig(const SinkageRigSettings& settings);
  ~SinkageRig() override;

  /// Stands still, whatever the load. State at the start.
  void hold();
  /// Moves down at this constant speed (> 0), whatever the load.
  void lower(double speed_m_s);
  /// Free on its slider under the load, with the velocity it has.
  void release();

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

  /// Mass that moves on the slider, foot included.
  double moving_mass_kg() const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace hoof::sim
