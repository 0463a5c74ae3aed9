// The whole way from recordings to a verdict, on plants whose truth is known because the model made
// them. Plants of another maker are tools/conceal's; these hold that the search finds what the
// model can say, that noise alone is no finding, and that threads change no byte.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tools/diagnose/diagnose.h"
#include "tools/diagnose/pendulum_model.h"
#include "tools/diagnose/verdict_json.h"
#include "tools/diagnose/where.h"

using namespace hoof;
using namespace hoof::tools;

namespace {

constexpr double kPositionNoise_rad = 0.0005;
constexpr double kTorqueNoise_Nm = 0.01;

double goal_rad(int recording, double t_s) {
  switch (recording) {
    case 0:
      return 0.8 * std::sin(2.5 * t_s);
    case 1:
      return 0.5 * std::sin(1.1 * t_s) + 0.3 * std::sin(6 * t_s);
    case 2:
      return std::abs(std::fmod(0.5 * t_s, 2.0) - 1) * 1.6 - 0.8;  // slow triangle
    default:
      return 0.7 * std::sin(1.7 * t_s) + 0.2 * std::sin(9 * t_s);
  }
}

DataSet blank(double wrong) {
  DataSet set;
  set.file = "made";
  set.name = "made";
  set.setup.law = DriveLaw::kImpedance;
  set.setup.values = {{"payload_mass", {0.5, 0}},
                      {"payload_length", {0.15, 0}},
                      {"arm_mass", {0.06 * wrong, 0.02}},
                      {"armature", {0.004 * wrong, 0.001}},
                      {"coulomb", {0.06 * wrong, 0.02}},
                      {"viscous", {0.02 * wrong, 0.008}},
                      {"control_period", {0.002, 0}},
                      {"kp", {6, 0}},
                      {"kd", {0.25, 0}},
                      {"torque_limit", {4, 0}}};
  for (int k = 0; k < 4; ++k) {
    Recording recording;
    recording.name = "r" + std::to_string(k) + ".csv";
    recording.holdout = k == 3;
    recording.setup = set.setup;
    for (int i = 0; i < 1000; ++i) {
      recording.time_s.push_back(0.005 * i);
      recording.channels["position_goal"].push_back(goal_rad(k, 0.005 * i));
    }
    recording.channels["position"].assign(1000, goal_rad(k, 0));
    recording.channels["torque"].assign(1000, 0);
    set.recordings.push_back(std::move(recording));
  }
  return set;
}

/// Puts what a plant with the setup and goals of `truth` and these effects gives, with noise, into
/// the set.
void record(const DataSet& truth, const std::vector<ActiveEffect>& effects, std::uint64_t seed,
            DataSet& set) {
  const PendulumModel plant({truth});
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> setup;
  for (const DoubtfulValue& d : plant.doubtful()) setup.push_back(d.value);
  for (int k = 0; k < plant.recordings(); ++k) {
    const Prediction p = plant.predict(k, setup, effects, Rollout::kFree);
    auto& channels = set.recordings[static_cast<std::size_t>(k)].channels;
    for (std::size_t i = 0; i < 1000; ++i) {
      channels["position"][i] = p[0][i] + kPositionNoise_rad * normal(random);
      channels["torque"][i] = p[1][i] + kTorqueNoise_Nm * normal(random);
    }
  }
}

/// The set's own setup is off by `wrong`.
DataSet made(const std::vector<ActiveEffect>& effects, double wrong, std::uint64_t seed) {
  DataSet set = blank(wrong);
  record(blank(1), effects, seed, set);
  return set;
}

ActiveEffect effect(const char* name, std::vector<double> values) {
  return {sim::find_effect(name), std::move(values)};
}

}  // namespace

TEST_CASE("diagnose: parameters that are off by a quarter are no missing physics") {
  const DataSet set = made({}, 1.25, 11);
  const Verdict verdict = diagnose({set}, {});
  CHECK(verdict.verdict == "none");
  CHECK(verdict.probabilities.at("none") > 0.7);
  // Refitted, what is left is noise, and at the start of each rollout what its first sample's noise
  // makes: speed is known there to noise / (0.005 s sqrt(10)) = 0.03 rad/s only, a few milliradians
  // until the loop has drawn them in.
  CHECK(verdict.before.fit.at("position_rmse") < 2.5 * kPositionNoise_rad);
  CHECK(verdict.before.fit.at("position_rmse") > 0.95 * kPositionNoise_rad);
  CHECK(verdict.before.fit.at("torque_rmse") == Approx(kTorqueNoise_Nm).epsilon(0.25));
}

TEST_CASE("diagnose: one effect is named, with its parameters, and held-out data agree") {
  const DataSet set = made({effect("load_dependent_friction", {0.08})}, 1.2, 12);
  const Verdict verdict = diagnose({set}, {});
  CHECK(verdict.verdict == "missing_physics");
  REQUIRE_FALSE(verdict.named.empty());
  CHECK(verdict.effects.front().name == "load_dependent_friction");
  const ParameterEstimate& found = verdict.effects.front().parameters.front();
  CHECK(found.value == Approx(0.08).epsilon(0.1));
  CHECK(found.low95 < found.value);
  CHECK(found.high95 > found.value);
  CHECK(verdict.after.holdout.at("torque_rmse") < verdict.before.holdout.at("torque_rmse"));
  CHECK(verdict.after.holdout.at("torque_rmse") == Approx(kTorqueNoise_Nm).epsilon(0.1));
}

TEST_CASE(
    "diagnose: about one angle a spring and cogging cannot be told apart, and both are said") {
  // Three degrees about half a radian: of any torque that depends on the angle its value and slope
  // are all that is felt.
  DataSet truth = blank(1), set = blank(1);
  for (DataSet* s : {&truth, &set}) {
    for (Recording& r : s->recordings) {
      for (double& goal : r.channels["position_goal"]) goal = 0.5 + 0.06 * goal;
      r.channels["position"].assign(1000, r.channels["position_goal"][0]);
    }
  }
  record(truth, {effect("parasitic_spring", {0.2, -0.4})}, 15, set);
  const Verdict verdict = diagnose({set}, {});
  CHECK(verdict.verdict == "not_separable");
  REQUIRE_FALSE(verdict.not_separable.empty());
  const auto& both = verdict.not_separable.front();
  CHECK(std::count(both.begin(), both.end(), "parasitic_spring") == 1);
  CHECK(std::count(both.begin(), both.end(), "cogging_torque") == 1);
}

TEST_CASE("diagnose: what held-out recordings speak against is not named") {
  // Something was so in three recordings, and the other way round in the one that is held out.
  DataSet set = made({effect("directional_friction", {0.4})}, 1, 16);
  const DataSet against = made({effect("directional_friction", {-0.4})}, 1, 17);
  set.recordings[3] = against.recordings[3];
  const Verdict verdict = diagnose({set}, {});
  CHECK(verdict.verdict != "missing_physics");
  CHECK(verdict.verdict != "not_separable");
  CHECK(verdict.probabilities.at("directional_friction") < 0.05);
  // With the same in all of them it is.
  CHECK(diagnose({made({effect("directional_friction", {0.4})}, 1, 16)}, {}).verdict ==
        "missing_physics");
}

TEST_CASE("diagnose: friction that nobody stated is found, and is no missing physics") {
  DataSet set = made({}, 1.1, 14);
  for (Recording& recording : set.recordings) recording.setup.values.erase("coulomb");
  set.setup.values.erase("coulomb");
  const Verdict verdict = diagnose({set}, {});
  CHECK(verdict.verdict == "none");
  bool found = false;
  for (const SetupEstimate& estimate : verdict.setup) {
    if (estimate.name != "coulomb") continue;
    found = true;
    CHECK(estimate.before == Approx(0.06).epsilon(0.1));
  }
  CHECK(found);
}

TEST_CASE("diagnose: any number of threads gives the same bytes") {
  const DataSet set = made({effect("stribeck_friction", {0.05, 0.3})}, 0.85, 13);
  DiagnoseOptions one, three;
  one.threads = 1;
  three.threads = 3;
  CHECK(verdict_json(diagnose({set}, one)).dump() == verdict_json(diagnose({set}, three)).dump());
}

TEST_CASE("spans of strength take at most half of the time, about its peaks") {
  std::vector<double> time_s, strength;
  for (int i = 0; i < 2000; ++i) {
    time_s.push_back(0.005 * i);
    strength.push_back(std::abs(time_s.back() - 3) < 0.5 ? 1 : 0.01);
  }
  const std::vector<double> level = smoothed(time_s, strength, 0.1);
  const auto spans = spans_above(time_s, level, strong_bound({&level}), 0.05);
  REQUIRE(spans.size() == 1);
  CHECK(spans[0].first == Approx(2.5).margin(0.06));
  CHECK(spans[0].second == Approx(3.5).margin(0.06));
}
