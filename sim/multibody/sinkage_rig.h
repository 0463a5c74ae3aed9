// A carriage on a vertical slider presses a foot into the ground.
#pragma once

#include "sim/multibody/foot.h"
#include "sim/multibody/foot_rig.h"

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
class SinkageRig final : public FootRig {
 public:
  explicit SinkageRig(const SinkageRigSettings& settings);

  /// Stands still, whatever the load. State at the start.
  void hold();
  /// Moves down at this constant speed (> 0), whatever the load.
  void lower(double speed_m_s);
  /// Free on its slider under the load, with the velocity it has.
  void release();

  void step(double interval_s) override;

  /// Mass that moves on the slider, foot included.
  using FootRig::moving_mass_kg;

 private:
  OdeSlider slider_;
  double load_N_;
  bool released_ = false;
};

}  // namespace hoof::sim
