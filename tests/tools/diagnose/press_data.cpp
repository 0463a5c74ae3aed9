#include "tests/tools/diagnose/press_data.h"

#include <cmath>
#include <random>
#include <stdexcept>

namespace hoof::tests {

using tools::DataSet;
using tools::Recording;

namespace {

constexpr double kPeriod_s = 0.02;
constexpr double kSurface_m = -0.009;

void travel(std::vector<double>& depths_m, double to_m, double speed_m_s) {
  const double from_m = depths_m.back();
  const int steps = static_cast<int>(std::ceil(std::abs(to_m - from_m) / (speed_m_s * kPeriod_s)));
  for (int i = 1; i <= steps; ++i) depths_m.push_back(from_m + (to_m - from_m) * i / steps);
}

}  // namespace

DataSet sand_set(const std::vector<PressPlan>& plans) {
  DataSet set;
  set.file = "press.toml";
  set.name = "press";
  set.rig = tools::RigKind::kPlateSand;
  set.setup.values = {{"k_c", {0, 2e4}},
                      {"k_phi", {3e6, 3e6}},
                      {"n", {1.1, 0.3}},
                      {"surface_height", {kSurface_m, 0}}};
  for (const PressPlan& plan : plans) {
    Recording recording;
    recording.name = plan.name;
    recording.holdout = plan.holdout;
    recording.setup = set.setup;
    recording.setup.values["diameter"] = {plan.diameter_m, 0};
    std::vector<double> depths_m = {-0.001};
    for (int cycle = 0; cycle < plan.cycles; ++cycle) {
      travel(depths_m, plan.deepest_m, plan.speed_m_s);
      if (plan.back_m > 0) travel(depths_m, plan.deepest_m - plan.back_m, plan.speed_m_s);
      if (plan.cycles > 1) travel(depths_m, -0.001, plan.speed_m_s);
    }
    auto& heights_m = recording.channels["position"];
    for (std::size_t i = 0; i < depths_m.size(); ++i) {
      recording.time_s.push_back(5 + kPeriod_s * static_cast<double>(i));
      heights_m.push_back(kSurface_m - depths_m[i]);
    }
    recording.channels["force"].assign(heights_m.size(), 0.0);
    set.recordings.push_back(recording);
  }
  return set;
}

DataSet block_set(double largest_N) {
  DataSet set;
  set.file = "block.toml";
  set.name = "block";
  set.rig = tools::RigKind::kRigidPress;
  Recording recording;
  recording.name = "block.csv";
  for (int i = 0; i <= 400; ++i) {
    recording.time_s.push_back(kPeriod_s * i);
    recording.channels["force"].push_back(largest_N * (1 - std::abs(i - 200) / 200.0));
    recording.channels["position"].push_back(0.05);
  }
  set.recordings.push_back(recording);
  return set;
}

void simulate_into(std::vector<DataSet>& sets, const std::vector<double>& setup,
                   const std::vector<tools::ActiveEffect>& effects, double force_noise_N,
                   double position_noise_m, std::uint64_t seed) {
  const tools::PressModel model(sets);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  int index = 0;
  for (DataSet& set : sets) {
    for (Recording& recording : set.recordings) {
      const std::string channel = model.channels(index)[0];
      const double sigma = channel == "force" ? force_noise_N : position_noise_m;
      const auto predicted = model.predict(index++, setup, effects, tools::Rollout::kFree);
      auto& values = recording.channels[channel];
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = predicted[0][i] + sigma * normal(random);
      }
    }
  }
}

tools::ActiveEffect active(const std::string& name, const std::vector<double>& values) {
  const sim::EffectInfo* info = sim::find_effect(name);
  if (info == nullptr) throw std::invalid_argument(name);
  return {.info = info, .values = values};
}

}  // namespace hoof::tests
