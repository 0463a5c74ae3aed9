// The servo pendulum as the search sees it.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/rigs/servo_pendulum.h"
#include "tools/diagnose/goal_bends.h"
#include "tools/diagnose/goal_losses.h"
#include "tools/diagnose/rig_model.h"

namespace hoof::tools {

/// Samples over which a torque that is an input is smoothed, from not at all.
inline constexpr std::array<std::size_t, 5> kSmoothingSpans = {1, 5, 9, 17, 33};
inline constexpr std::size_t kUsualSmoothing = 2;  // of them

class PendulumModel final : public RigModel {
 public:
  /// @throws UserError naming file and key where something that the rig needs is missing
  explicit PendulumModel(std::vector<DataSet> data_sets);

  int recordings() const override { return static_cast<int>(runs_.size()); }
  const Recording& recording(int index) const override { return *runs_[index].recording; }
  const std::vector<std::string>& channels(int index) const override {
    return runs_[index].channels;
  }
  double stated_noise(int recording, const std::string& channel) const override;
  double input_noise(int recording, const std::string& channel) const override;
  const std::vector<DoubtfulValue>& doubtful() const override { return doubtful_; }
  const std::vector<const sim::EffectInfo*>& effects() const override { return effects_; }
  double unit_of(const sim::EffectParameter& parameter) const override;
  double complexity(const sim::EffectInfo& effect) const override;
  std::vector<Counted> counted(const sim::EffectInfo& effect) const override;
  Prediction predict(int recording, std::span<const double> setup,
                     std::span<const ActiveEffect> effects, Rollout rollout) const override;
  std::vector<double> strength(int recording, std::span<const double> setup,
                               std::span<const ActiveEffect> effects) const override;
  std::vector<Condition> conditions(int recording) const override;

 private:
  struct Run {
    const DataSet* data_set = nullptr;
    const Recording* recording = nullptr;
    sim::PendulumInputs inputs;
    sim::PendulumSettings settings;   // as stated
    sim::PendulumStart start;         // as measured at the first sample
    sim::PendulumStart fitted_start;  // of what is fitted: better where it begins at rest
    sim::PendulumCorrection correction;
    double wander_rad = 0, wander_rad_s = 0;  // 1-sigma of the corrected state before a sample
    std::vector<std::string> channels;
    double longest_step_s = 0;
    int timing = -1;                     // in doubtful_
    int switch_timing = -1;              // the same; where the drive is turned off or on
    int start_speed = -1;                // the same; where it begins in motion
    int smoothing = -1;                  // the same; of a torque that is an input
    double start_speed_doubt_rad_s = 0;  // 1 sigma; 0: it begins at rest, or nothing tells
    GoalBends goal_bends;
    std::optional<GoalLosses> losses;   // none: nothing tells, or too little
    std::map<std::string, int> doubts;  // key of the setup to index in doubtful_

    bool predicts(const std::string& name) const {
      return std::find(channels.begin(), channels.end(), name) != channels.end();
    }
  };

  static double stated_noise(const DataSet& data_set, const std::string& channel);
  void add(const DataSet& data_set, const Recording& recording);
  void add_doubts(Run& run);
  /// Its index; of two with one name there is one.
  int shared_doubt(const DoubtfulValue& doubt);
  void add_timing(Run& run);
  void add_switch_timing(Run& run, double sample_s);
  void add_start_speed(Run& run);
  void add_smoothing(Run& run);
  std::vector<double> smoothed_torque_Nm(const Run& run, double smoothing) const;
  void choose_effects();
  sim::PendulumSettings settings(const Run& run, std::span<const double> setup) const;
  void estimate_start(Run& run) const;
  void start_in_motion(Run& run) const;
  void start_at_rest(Run& run) const;
  void choose_correction(Run& run) const;
  void look_for_losses(Run& run) const;
  void doubt_losses();
  void simulate(const Run& run, std::span<const double> setup, std::span<const ActiveEffect> active,
                Rollout rollout, sim::PendulumTrace& trace) const;
  void measure_effort();

  std::vector<DataSet> data_sets_;
  std::map<const Recording*, double> input_noise_Nm_;  // of torques that are inputs, as recorded
  /// The same torques, smoothed over kSmoothingSpans.
  std::map<const Recording*, std::vector<std::vector<double>>> smoothed_Nm_;
  std::vector<Run> runs_;
  std::vector<DoubtfulValue> doubtful_;
  std::vector<const sim::EffectInfo*> effects_;
  double torque_rms_Nm_ = 0, torque_peak_Nm_ = 0;  // over all recordings
};

}  // namespace hoof::tools
