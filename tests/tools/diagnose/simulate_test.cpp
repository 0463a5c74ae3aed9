// hoof simulate's own part: setup and effects of a file to a model, errors by recording and role.
#include <catch2/catch.hpp>
#include <cmath>

#include "tools/diagnose/simulate_rig.h"
#include "tools/run/errors.h"

using namespace hoof::tools;
using hoof::sim::EffectInfo;
using hoof::sim::find_effect;

namespace {

/// Predicts `offset` + the first effect's first parameter + 10 times the number of the recording,
/// of recordings that are all zero.
class FlatModel final : public RigModel {
 public:
  FlatModel() {
    for (const char* name : {"runs/a.csv", "more/a.csv", "b.csv"}) {
      Recording r;
      r.name = name;
      r.time_s = {0, 1, 2, 3};
      r.channels["position"] = {0, 0, std::nan(""), 0};
      r.holdout = recordings_.size() == 2;
      recordings_.push_back(r);
    }
  }
  int recordings() const override { return int(recordings_.size()); }
  const Recording& recording(int index) const override { return recordings_[std::size_t(index)]; }
  const std::vector<std::string>& channels(int) const override { return channels_; }
  double stated_noise(int, const std::string&) const override { return 0; }
  const std::vector<DoubtfulValue>& doubtful() const override { return doubtful_; }
  const std::vector<const EffectInfo*>& effects() const override { return effects_; }
  Prediction predict(int recording, std::span<const double> setup,
                     std::span<const ActiveEffect> effects, Rollout rollout) const override {
    REQUIRE(rollout == Rollout::kFree);
    const double effect = effects.empty() ? 0 : effects[0].values[0];
    return {std::vector<double>(4, setup[0] + effect + 10 * recording)};
  }
  std::vector<Condition> conditions(int) const override { return {}; }

 private:
  std::vector<Recording> recordings_;
  std::vector<std::string> channels_ = {"position"};
  std::vector<DoubtfulValue> doubtful_ = {{"offset", 1, 1, 0}};
  std::vector<const EffectInfo*> effects_ = {find_effect("backlash")};
};

}  // namespace

TEST_CASE("Errors of a simulation are of each recording and of all of a role") {
  const FlatModel model;
  const Simulation plain = simulate_rig(model, {});
  REQUIRE(plain.recordings.size() == 3);
  CHECK(plain.recordings[0].rmse == std::vector<double>{1});
  CHECK(plain.recordings[1].rmse == std::vector<double>{11});
  CHECK(plain.fit.at("position") == Approx(std::sqrt((1.0 + 121.0) / 2)));
  CHECK(plain.holdout.at("position") == Approx(21));
  CHECK(prediction_file_names(plain) == std::vector<std::string>{"a.csv", "a-2.csv", "b.csv"});
  const auto json = simulation_json(plain);
  CHECK(json["recordings"][1]["file"] == "a-2.csv");
  CHECK(json["recordings"][1]["position_rmse"] == 11.0);
  CHECK(json["recordings"][2]["role"] == "holdout");
  CHECK(json["holdout"]["position_rmse"] == 21.0);
}

TEST_CASE("A file of effects gives the model its setup and effects, and what is not used is told") {
  const FlatModel model;
  EffectsFile file;
  file.effects = {{find_effect("backlash"), {0.25}}};
  file.setup = {{"offset", 2}, {"kt", 5}};
  const Simulation improved = simulate_rig(model, file);
  CHECK(improved.recordings[0].rmse[0] == Approx(2.25));
  CHECK(improved.unused_setup == std::vector<std::string>{"kt"});
  file.setup = {{"offset", -1}};
  CHECK_THROWS_WITH(simulate_rig(model, file), Catch::Contains("setup.offset is below"));
  file.effects = {{find_effect("cogging_torque"), {0.1, 8, 0}}};
  CHECK_THROWS_WITH(simulate_rig(model, file),
                    "--effects: cogging_torque cannot act on this rig with these recordings; those "
                    "that can: backlash");
}
