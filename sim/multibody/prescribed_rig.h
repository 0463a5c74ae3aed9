// A foot moved along a given path, whatever the ground does: the paper's traction test.
#pragma once

#include "sim/multibody/foot_rig.h"
#include "sim/multibody/leg.h"

namespace hoof::sim {

/// Middle of the sole in the x-z plane of the leg.
struct FootPoint {
  double x_m = 0.0;
  double z_m = 0.0;
};

/// The middle segment follows the points given; its pitch is that of the shank of the leg, by the
/// leg's inverse kinematics. The toes still hang on their hinges and their drive.
class PrescribedRig final : public FootRig {
 public:
  /// @throws std::invalid_argument where the leg cannot reach the start
  PrescribedRig(const Foot& foot, const Leg& leg, FootPoint start);

  /// Where the foot shall be at the end of the next step(). Without a new target it stands still.
  /// @throws std::invalid_argument where the leg cannot reach it
  void move_to(FootPoint target);

  void step(double interval_s) override;
  RigEnergy energy() const override;

 private:
  Leg leg_;
  Pose target_;
};

}  // namespace hoof::sim
