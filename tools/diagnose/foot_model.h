// Recordings of the project's own foot as the search sees them: the real control code against the
// simulator, on fast soil, once per prediction.
//
// Inputs of a rollout are the operator's orders. All else, the goals of the position loops
// included, is the firmware's own answer to the predicted plant; nothing that was measured goes in.
// A session recorded on grains is predicted on the fast soil that its settings name.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/diagnose/foot_effects.h"
#include "tools/diagnose/foot_session.h"
#include "tools/diagnose/prediction_cache.h"
#include "tools/diagnose/rig_model.h"

namespace hoof::tools {

/// Effects are named "backlash@toe", and in the verdict "backlash", with its joint beside
/// (name_joints). What [setup] does not state is as the session's settings have it, and exact but
/// for the stiffness of a fitted fast soil, whose fit tells its spread.
class FootModel final : public RigModel {
 public:
  /// @throws UserError naming the session or the key that is wrong
  explicit FootModel(const std::vector<DataSet>& data_sets);

  int recordings() const override { return static_cast<int>(runs_.size()); }
  const Recording& recording(int index) const override { return runs_[index].recording; }
  const std::vector<std::string>& channels(int index) const override {
    return runs_[index].channels;
  }
  /// Of the bus: a code's width over the root of 12. Of ground and depth none is known.
  double stated_noise(int recording, const std::string& channel) const override;
  const std::vector<DoubtfulValue>& doubtful() const override { return doubtful_; }
  const std::vector<const sim::EffectInfo*>& effects() const override { return effects_.list(); }
  double unit_of(const sim::EffectParameter& parameter) const override {
    return effects_.unit_of(parameter);
  }
  bool costly() const override { return true; }
  Prediction predict(int recording, std::span<const double> setup,
                     std::span<const ActiveEffect> effects, Rollout rollout) const override;
  std::vector<Condition> conditions(int recording) const override;

 private:
  struct Run {
    Recording recording;
    FootSession session;
    std::vector<std::string> channels;
    std::map<std::string, int> doubts;  // number of the setup to index in doubtful_
  };

  void add(const DataSet& data_set, const Recording& recording);
  void take_setup(const DataSet& data_set, Run& run);
  void add_doubt(Run& run, const std::string& key, const std::string& name, double value,
                 double sigma);
  void choose_effects();
  Prediction replay(const Run& run, std::span<const double> setup,
                    std::span<const ActiveEffect> effects) const;

  std::vector<Run> runs_;
  std::vector<DoubtfulValue> doubtful_;
  FootEffects effects_;
  mutable PredictionCache cache_;
};

}  // namespace hoof::tools
