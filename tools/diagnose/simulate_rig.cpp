#include "tools/diagnose/simulate_rig.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tools/diagnose/foot_effects.h"
#include "tools/diagnose/toml_view.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;

class SquareSum {
 public:
  void add(const std::vector<double>& measured, const std::vector<double>& predicted) {
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const double error = measured[i] - predicted.at(i);
      if (std::isnan(error)) continue;
      sum_ += error * error;
      ++count_;
    }
  }
  double root_mean() const {
    return count_ > 0 ? std::sqrt(sum_ / double(count_)) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double sum_ = 0;
  std::int64_t count_ = 0;
};

void require_usable(const RigModel& model, const EffectsFile& file) {
  for (const ActiveEffect& effect : file.effects) {
    const auto& usable = model.effects();
    const auto fits = [&effect](const sim::EffectInfo* info) {
      return plain_effect_name(info->name) == effect.info->name &&
             (effect.joint.empty() || joint_of_effect(info->name) == effect.joint);
    };
    if (std::any_of(usable.begin(), usable.end(), fits)) continue;
    std::vector<std::string> names;
    for (const sim::EffectInfo* info : usable) {
      if (info->listed) names.emplace_back(info->name);
    }
    throw UserError(
        "--effects: " + std::string(effect.info->name) +
        " cannot act on this rig with these recordings; those that can: " + one_of(names));
  }
}

std::vector<double> setup_values(const RigModel& model, const EffectsFile& file,
                                 std::vector<std::string>& unused) {
  std::vector<double> values;
  std::map<std::string, double> left = file.setup;
  for (const DoubtfulValue& doubtful : model.doubtful()) {
    const auto found = left.find(doubtful.name);
    values.push_back(found == left.end() ? doubtful.value : found->second);
    if (found != left.end() && found->second < doubtful.low) {
      throw UserError("--effects: setup." + doubtful.name + " is below what it can be");
    }
    if (found != left.end()) left.erase(found);
  }
  for (const auto& [name, value] : left) unused.push_back(name);
  return values;
}

}  // namespace

Simulation simulate_rig(const RigModel& model, const EffectsFile& file) {
  require_usable(model, file);
  Simulation simulation;
  const std::vector<double> setup = setup_values(model, file, simulation.unused_setup);
  std::map<std::string, SquareSum> fit, holdout;
  for (int r = 0; r < model.recordings(); ++r) {
    SimulatedRecording done{&model.recording(r), model.channels(r), {}, {}};
    done.prediction = model.predict(r, setup, file.effects, Rollout::kFree);
    for (std::size_t c = 0; c < done.channels.size(); ++c) {
      const auto& measured = done.recording->channels.at(done.channels[c]);
      SquareSum own;
      own.add(measured, done.prediction.at(c));
      done.rmse.push_back(own.root_mean());
      auto& role = done.recording->holdout ? holdout : fit;
      role[done.channels[c]].add(measured, done.prediction[c]);
    }
    simulation.recordings.push_back(std::move(done));
  }
  for (const auto& [channel, sum] : fit) simulation.fit[channel] = sum.root_mean();
  for (const auto& [channel, sum] : holdout) simulation.holdout[channel] = sum.root_mean();
  return simulation;
}

std::vector<std::string> prediction_file_names(const Simulation& simulation) {
  std::set<std::string> taken;
  std::vector<std::string> names;
  for (const SimulatedRecording& done : simulation.recordings) {
    const std::string stem = std::filesystem::path(done.recording->name).stem().string();
    std::string name = stem + ".csv";
    for (int n = 2; !taken.insert(name).second; ++n) name = stem + "-" + std::to_string(n) + ".csv";
    names.push_back(name);
  }
  return names;
}

Json simulation_json(const Simulation& simulation) {
  const auto put = [](Json& json, const std::string& channel, double rmse) {
    if (std::isfinite(rmse)) json[channel + "_rmse"] = rmse;
  };
  Json json;
  json["format"] = kFormat;
  json["recordings"] = Json::array();
  const std::vector<std::string> files = prediction_file_names(simulation);
  for (std::size_t r = 0; r < files.size(); ++r) {
    const SimulatedRecording& done = simulation.recordings[r];
    Json one = {{"recording", done.recording->name},
                {"role", done.recording->holdout ? "holdout" : "fit"},
                {"file", files[r]}};
    for (std::size_t c = 0; c < done.channels.size(); ++c) put(one, done.channels[c], done.rmse[c]);
    json["recordings"].push_back(std::move(one));
  }
  json["fit"] = json["holdout"] = Json::object();
  for (const auto& [channel, rmse] : simulation.fit) put(json["fit"], channel, rmse);
  for (const auto& [channel, rmse] : simulation.holdout) put(json["holdout"], channel, rmse);
  return json;
}

}  // namespace hoof::tools
