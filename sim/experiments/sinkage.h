// The sinkage test: a loaded foot is lowered onto level sand and let go.
#pragma once

#include "sim/config/reader.h"
#include "sim/experiments/experiment.h"
#include "sim/multibody/sinkage_rig.h"

namespace hoof::sim {

struct SinkageSettings {
  double load_N = 0;
  LoadAs load_as = LoadAs::kForce;
  double speed_m_s = 0;
  double toe_rad = 0;
  double start_height_m = 0;
  double rest_speed_m_s = 0;
  double rest_time_s = 0;
  double time_limit_s = 0;
};

/// Reads what the sinkage test itself needs from the section "experiment" of a run.
SinkageSettings read_sinkage(const Reader& section);

/// Depth is the way of the sole down since first contact (the paper's definition). The test is over
/// when the foot rests or its time is up.
class Sinkage final : public Experiment {
 public:
  /// @param plant its rig must be a SinkageRig
  Sinkage(const SinkageSettings& settings, std::unique_ptr<Plant> plant);

  void foot_ready() override;
  bool finished() const override { return phase_ == Phase::kFinished; }
  double progress() const override;

  bool rested() const { return rested_; }
  double max_depth_m() const { return max_depth_m_; }
  /// How far the sole itself went below the height of first contact: without the spines, which
  /// touch before it. Negative while it stands above.
  double max_sole_depth_m() const { return max_depth_m_ - below_sole_m_; }
  double final_depth_m() const { return depth_m(); }

 protected:
  void after_interval() override;
  double depth_m() const override;

 private:
  double sole_z_m() const { return plant().rig().foot_position_m().z(); }

  SinkageSettings settings_;
  SinkageRig& rig_;
  double below_sole_m_ = 0;  // lowest point of the foot under its sole
  double lowered_from_m_ = 0;
  double contact_z_m_ = 0;
  double contact_time_s_ = 0;
  double slow_since_s_ = 0;
  double max_depth_m_ = 0;
  bool rested_ = false;
};

}  // namespace hoof::sim
