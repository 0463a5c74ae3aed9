// The rigs plate_sand and rigid_press of one machine as the search sees them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sim/rigs/plate_press.h"
#include "tools/diagnose/rig_model.h"

namespace hoof::tools {

/// An effect that these recordings cannot show, and why: for the report.
struct HiddenEffect {
  std::string effect;
  std::string reason;
};

/// Any mix of plate_sand and rigid_press: setup values that two data sets state alike are one
/// number, and effects are shared, so that a press on a block tells of the rig under the sand.
/// Both rollouts are the same: nothing here is integrated in time.
class PressModel : public RigModel {
 public:
  /// @throws UserError where a data set is of another rig
  explicit PressModel(const std::vector<DataSet>& data_sets);

  int recordings() const override { return static_cast<int>(presses_.size()); }
  const Recording& recording(int index) const override { return press(index).recording; }
  const std::vector<std::string>& channels(int recording) const override;
  double stated_noise(int recording, const std::string& channel) const override;
  const std::vector<DoubtfulValue>& doubtful() const override { return doubtful_; }
  const std::vector<const sim::EffectInfo*>& effects() const override { return effects_; }
  Prediction predict(int recording, std::span<const double> setup,
                     std::span<const ActiveEffect> effects, Rollout rollout) const override;
  bool quick() const override { return true; }
  std::vector<Condition> conditions(int recording) const override;
  std::vector<QualityNote> notes() const override;

  const std::vector<HiddenEffect>& hidden_effects() const { return hidden_; }

  /// How far presses of the plate of that width are off the mean of the others at the same depth,
  /// going down, rms. NaN where there are no two that reach the same depths.
  double repeat_scatter_N(double width_m) const;

 private:
  /// A setup value as a prediction finds it: fixed, or the doubtful number of that index.
  struct Quantity {
    bool known = false;
    double value = 0;
    int doubtful = -1;
  };

  struct Press {
    Recording recording;
    RigKind rig = RigKind::kPlateSand;
    std::map<std::string, double> noise;
    Quantity k_c, k_phi, n, diameter, width, length, surface_height, wall_distance;
    sim::PressPath path;          // sand
    std::vector<double> force_N;  // block: missing samples as zero
    std::vector<bool> compared;
    std::vector<std::size_t> light;  // block: samples that tell the height of contact
  };

  const Press& press(int index) const { return presses_[static_cast<std::size_t>(index)]; }
  Quantity quantity(const DataSet& set, const Recording& recording, const std::string& key);
  void read_sand(Press& press, int& presses_before);
  static void read_block(Press& press);
  static bool states_contact(const Press& press);
  static double value(const Quantity& quantity, std::span<const double> setup);
  sim::PressBench bench(const Press& press, std::span<const double> setup) const;
  std::vector<double> predict_sand(const Press& press, std::span<const double> setup,
                                   sim::SoilEffects effects) const;
  std::vector<double> predict_block(const Press& press, std::span<const double> setup,
                                    sim::SoilEffects effects) const;
  struct Span;
  Span span() const;
  void choose_effects();
  static std::string why_hidden(const sim::EffectInfo& effect, const Span& span);
  std::vector<double> condition_depths_m() const;

  std::vector<Press> presses_;
  std::vector<DoubtfulValue> doubtful_;
  std::vector<SetupValue> stated_;  // of doubtful_, to know a value that is stated alike
  std::vector<const sim::EffectInfo*> effects_;
  std::vector<HiddenEffect> hidden_;
};

}  // namespace hoof::tools
