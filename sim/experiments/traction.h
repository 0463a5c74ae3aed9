// The traction test: a foot is pulled through the sand along the lower part of an ellipse.
#pragma once

#include "sim/config/reader.h"
#include "sim/experiments/experiment.h"
#include "sim/multibody/prescribed_rig.h"

namespace hoof::sim {

/// Ellipse of the middle of the sole about x = 0, run through so that the lower half goes to -x.
struct StanceEllipse {
  double half_length_m = 0;
  double half_height_m = 0;
  double centre_height_m = 0;

  /// @param turns place on the path: 0 = its top, 0.5 its deepest point
  FootPoint at(double turns) const;
  /// Distance of a point from the path, m: the least over all phases.
  double distance_m(const FootPoint& p) const;
};

struct TractionSettings {
  double frequency_Hz = 0;
  double toe_rad = 0;
  StanceEllipse ellipse;
  int cycles = 1;
  bool prescribed = false;
};

/// Reads what the traction test itself needs from the section "experiment" of a run.
TractionSettings read_traction(const Reader& section);

/// Depth is the sole's below the level sand. Over after the given number of stances, when the foot
/// has left the sand.
class Traction final : public Experiment {
 public:
  /// @param plant its rig is a TractionRig, or a PrescribedRig where settings.prescribed
  Traction(const TractionSettings& settings, std::unique_ptr<Plant> plant);

  void foot_ready() override;
  bool finished() const override { return phase_ == Phase::kFinished; }
  double progress() const override;
  double max_depth_m() const { return max_depth_m_; }

 protected:
  void before_interval() override;
  void after_interval() override;
  double depth_m() const override;

 private:
  double prescribed_turns(double time_s) const;

  TractionSettings settings_;
  PrescribedRig* prescribed_;  // null under firmware control
  bool moving_ = false;
  double started_s_ = 0;
  double last_touch_s_ = 0;
  int stances_ = 0;
  bool in_stance_ = false;
  double max_depth_m_ = 0;
};

}  // namespace hoof::sim
