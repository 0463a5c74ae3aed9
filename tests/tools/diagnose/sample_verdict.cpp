#include "tests/tools/diagnose/sample_verdict.h"

#include <cmath>

namespace hoof::tests {
namespace {

using namespace hoof::tools;

constexpr int kSamples = 800;
constexpr double kStep_s = 0.01;

/// A triangle that cogging disturbs while it is slow.
ChannelTrace trace(const std::string& recording, bool holdout, double period_s) {
  ChannelTrace t;
  t.recording = recording;
  t.channel = "position";
  t.holdout = holdout;
  for (int i = 0; i < kSamples; ++i) {
    const double time_s = i * kStep_s;
    const double phase = std::fmod(time_s / period_s, 1.0);
    const double path = 1.2 * (phase < 0.5 ? 4 * phase - 1 : 3 - 4 * phase);
    const double noise = 0.002 * std::sin(1e4 * time_s * time_s);
    const double cogging = 0.05 * std::sin(8 * path + 0.4);
    t.time_s.push_back(time_s);
    t.before.push_back(path);
    t.after.push_back(path + 0.95 * cogging);
    t.measured.push_back(i % 200 == 77 ? std::nan("") : path + cogging + noise);
  }
  return t;
}

}  // namespace

Verdict sample_verdict() {
  Verdict v;
  v.verdict = "missing_physics";
  v.probabilities = {{"none", 0.01},     {"unknown", 0.02},           {"cogging_torque", 0.9},
                     {"backlash", 0.04}, {"stribeck_friction", 0.02}, {"supply_sag", 0.01}};
  v.effects = {{"cogging_torque",
                0.9,
                {{"amplitude", 0.031, "Nm", 0.027, 0.035},
                 {"order", 8, "1/rev", 8, 8},
                 {"phase", 0.4, "rad", 0.31, 0.49}}},
               {"backlash", 0.04, {{"gap", 0.003, "rad", 0.0, 0.01}}},
               {"stribeck_friction",
                0.02,
                {{"extra", 0.01, "Nm", 0.0, 0.03}, {"speed", 0.2, "rad/s", 0.01, 3.0}}},
               {"supply_sag", 0.005, {{"resistance", 0.1, "ohm", 0.0, 1.0}}}};
  v.named = {"cogging_torque"};
  v.next_experiment = "turn slowly through a whole turn at constant speed, both ways";
  v.channels = {"position"};
  v.recordings = {"slow_triangle.csv"};
  v.intervals = {{"slow_triangle.csv", 2.1, 3.9}, {"slow_triangle.csv", 5.0, 5.8}};
  v.condition = "|velocity| < 0.2";
  v.before = {{{"position_rmse", 0.0351}}, {{"position_rmse", 0.0362}}};
  v.after = {{{"position_rmse", 0.0031}}, {{"position_rmse", 0.0044}}};
  v.noise_floor = {{"position_rmse", 0.0014}};
  v.ablation = {
      {"nominal", {{"position_rmse", 0.0351}}, {{"position_rmse", 0.0362}}},
      {"nominal + cogging_torque", {{"position_rmse", 0.0031}}, {{"position_rmse", 0.0044}}},
      {"nominal + backlash", {{"position_rmse", 0.034}}, {{"position_rmse", 0.0359}}},
      {"nominal + stribeck_friction", {{"position_rmse", 0.0339}}, {{"position_rmse", 0.0371}}}};
  v.setup = {{"arm_mass", 0.016, 0.01, 0.021, 0.0155}, {"coulomb", 0.03, 0.03, 0.052, 0.034}};
  v.quality = {
      {"fast_sine.csv", "velocity", "lags the derivative of position by 20 ms", false},
      {"", "", "no recording turns a whole turn: order is known from a part of one", true}};
  v.hypotheses = {{"cogging_torque", 9, 5210.5, 1600, 812.25, 301.5, 0.9},
                  {"backlash", 7, 4402.1, 1600, 3.5, 1.25, 0.04},
                  {"stribeck_friction", 8, 4400.0, 1600, 2.0, -4.5, 0.02},
                  {"(friction of position)", 12, 4500.0, 1600, 1.5, 2.5, 0.02},
                  {"none", 6, 4398.0, 1600, 0, 0, 0.01}};
  v.traces = {trace("slow_triangle.csv", false, 8.0), trace("fast_sine.csv", true, 2.5)};
  v.evidence_for = {"The residual repeats with the angle, eight times a turn, in both directions.",
                    "Held-out error falls by 88 % with it, and by less than 1 % with any rival."};
  v.evidence_against = {"Only a part of a turn was travelled."};
  return v;
}

Verdict sample_verdict_none() {
  Verdict v = sample_verdict();
  v.verdict = "none";
  v.probabilities = {{"none", 0.97}, {"unknown", 0.02}, {"cogging_torque", 0.01}};
  v.effects = {{"cogging_torque", 0.01, {}}};
  v.named = {};
  v.channels = v.recordings = {};
  v.intervals = {};
  v.condition = "";
  v.next_experiment = "";
  v.after = v.before;
  v.evidence_for = v.evidence_against = {};
  v.quality = {};
  return v;
}

Verdict sample_verdict_not_separable() {
  Verdict v = sample_verdict();
  v.verdict = "not_separable";
  v.probabilities = {
      {"none", 0.0}, {"unknown", 0.02}, {"supply_sag", 0.5}, {"thermal_derating", 0.48}};
  v.effects = {{"supply_sag", 0.5, {{"resistance", 0.4, "ohm", 0.1, 0.9}}},
               {"thermal_derating",
                0.48,
                {{"fraction", 0.2, "1", 0.05, 0.4}, {"time_constant", 80, "s", 20, INFINITY}}}};
  v.named = {"supply_sag"};
  v.not_separable = {{"supply_sag", "thermal_derating"}};
  v.next_experiment = "hold one load for 60 s on a regulated supply";
  return v;
}

Verdict sample_verdict_unknown() {
  Verdict v = sample_verdict();
  v.verdict = "unknown_physics";
  v.probabilities = {{"none", 0.0}, {"unknown", 0.93}, {"cogging_torque", 0.07}};
  v.named = {};
  v.unknown_term = UnknownTerm{{"position", "velocity"},
                               "torque = sum of 12 bumps of position, odd in velocity",
                               0.6,
                               {{"position_rmse", 0.011}}};
  return v;
}

std::vector<DataSet> sample_data_sets() {
  DataSet set;
  set.file = "bench/arm.toml";
  set.name = "arm <on the bench>";
  set.rig = RigKind::kServoPendulum;
  Recording slow, fast;
  slow.name = "slow_triangle.csv";
  fast.name = "fast_sine.csv";
  fast.holdout = true;
  set.recordings = {slow, fast};
  return {set};
}

}  // namespace hoof::tests
