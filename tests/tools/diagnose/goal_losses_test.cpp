// Lost goals of joints whose losses are known, under both laws and with a setup that is off.
#include "tools/diagnose/goal_losses.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace hoof;
using namespace hoof::tools;

namespace {

constexpr double kSample_s = 0.005;
constexpr double kPositionNoise_rad = 5e-4;
constexpr int kSamples = 1600;

sim::PendulumSettings impedance() {
  sim::PendulumSettings s;
  s.law = sim::PendulumLaw::kImpedance;
  s.payload_mass_kg = 0.5;
  s.payload_length_m = 0.15;
  s.coulomb_Nm = 0.03;
  s.viscous_Nm_s_rad = 0.01;
  s.control_period_s = 0.001;
  s.kp_Nm_rad = 20;
  s.kd_Nm_s_rad = 0.5;
  s.torque_limit_Nm = 8;
  return s;
}

sim::PendulumSettings duty() {
  sim::PendulumSettings s = impedance();
  s.law = sim::PendulumLaw::kDuty;
  s.kp_duty = 400;
  s.counts_per_rad = 4096 / 6.283185307179586;
  s.supply_V = 8;
  s.kt_Nm_A = 0.8;
  s.resistance_ohm = 3;
  return s;
}

struct Joint {
  sim::PendulumSettings truth;
  std::vector<double> time_s, goal_rad, position_rad, torque_Nm;
  std::vector<sim::LostGoals> lost;
  sim::PendulumInputs inputs;

  Joint(const sim::PendulumSettings& settings, std::vector<sim::LostGoals> spans,
        std::span<const double> enable = {})
      : truth(settings), lost(std::move(spans)) {
    inputs.enable = enable;
    for (int i = 0; i < kSamples; ++i) {
      const double t = kSample_s * i;
      time_s.push_back(t);
      goal_rad.push_back(0.5 * std::sin(3 * t) + 0.3 * std::sin(8 * t + 1));
    }
    inputs.time_s = time_s;
    inputs.position_goal_rad = goal_rad;
    inputs.lost = lost;
    sim::PendulumTrace trace;
    simulate_pendulum(truth, inputs, {}, start(), {}, 1e-3, trace);
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0, 1);
    for (const double q : trace.position_rad) {
      position_rad.push_back(q + kPositionNoise_rad * noise(random));
    }
    torque_Nm = trace.torque_Nm;
    inputs.lost = {};
    inputs.position_rad = position_rad;
  }

  sim::PendulumStart start() const { return {.position_rad = goal_rad.front()}; }

  GoalLosses find(const sim::PendulumSettings& stated, std::span<const LossDoubt> doubts,
                  bool torque) const {
    std::vector<LossChannel> channels = {
        {LossChannel::kPosition, position_rad, kPositionNoise_rad}};
    if (torque) channels.push_back({LossChannel::kTorque, torque_Nm, 0.02});
    return find_losses(stated, inputs, start(), channels, doubts, 1e-3);
  }
};

/// Seconds in which one of the two says lost and the other does not.
double mistaken_s(const std::vector<sim::LostGoals>& a, const std::vector<sim::LostGoals>& b) {
  const auto in = [](const std::vector<sim::LostGoals>& spans, double t) {
    return std::any_of(spans.begin(), spans.end(), [t](const sim::LostGoals& span) {
      return t >= span.from_s && t < span.until_s;
    });
  };
  double sum = 0;
  for (double t = 0; t < kSample_s * kSamples; t += 1e-3) sum += in(a, t) != in(b, t) ? 1e-3 : 0;
  return sum;
}

const std::vector<sim::LostGoals> kLost = {
    {0.7304, 0.8204}, {1.9153, 2.0113}, {2.3001, 2.3501}, {4.4412, 4.5512}, {6.8025, 6.9525}};

}  // namespace

TEST_CASE(
    "goal losses: bursts are found to less than a sample at either end, without and with torque") {
  const bool torque = GENERATE(false, true);
  const bool duty_law = GENERATE(false, true);
  CAPTURE(torque, duty_law);
  const Joint joint(duty_law ? duty() : impedance(), kLost);
  const GoalLosses found = joint.find(joint.truth, {}, torque);
  CHECK(found.lost.size() == kLost.size());
  // Ends are read to the evaluation of the law, 1 ms, where the loop is stiff: three of them per
  // burst. Without that they lie in the middle of two samples, and 19 ms or more come together. A
  // soft loop shows an end late.
  CHECK(mistaken_s(found.lost, kLost) < (duty_law ? 0.006 : 0.003) * 5);
  CHECK(found.gain > 100);
}

TEST_CASE("goal losses: none where every goal arrived") {
  const bool torque = GENERATE(false, true);
  const bool duty_law = GENERATE(false, true);
  const Joint joint(duty_law ? duty() : impedance(), {});
  const GoalLosses found = joint.find(joint.truth, {}, torque);
  CHECK(found.lost.empty());
  CHECK(found.gain == 0);
}

TEST_CASE("goal losses: a load and a friction other than stated are no lost goals") {
  const bool duty_law = GENERATE(false, true);
  const bool any = GENERATE(false, true);
  CAPTURE(duty_law, any);
  const Joint joint(duty_law ? duty() : impedance(), any ? kLost : std::vector<sim::LostGoals>{});
  sim::PendulumSettings stated = joint.truth;
  stated.payload_mass_kg *= 0.8;
  stated.coulomb_Nm *= 1.5;
  const std::vector<LossDoubt> doubts = {{&sim::PendulumSettings::payload_mass_kg, 0.08},
                                         {&sim::PendulumSettings::coulomb_Nm, 0.01},
                                         {&sim::PendulumSettings::viscous_Nm_s_rad, 0.004}};
  const GoalLosses found = joint.find(stated, doubts, true);
  if (!any) CHECK(found.lost.empty());  // else one may come in two parts
  // Two samples a burst: what is left of a load that is a fifth off hides its ends.
  CHECK(mistaken_s(found.lost, joint.lost) <= 2 * kSample_s * static_cast<double>(kLost.size()));
}

TEST_CASE("goal losses: bursts while all goals come late are told from the lateness") {
  sim::PendulumSettings late = impedance();
  late.input_late_s = 0.02;
  Joint joint(late, kLost);
  sim::PendulumSettings stated = impedance();
  const GoalLosses found = joint.find(stated, {}, true);
  CHECK(found.lost.size() == kLost.size());
  // The lateness is looked for in half samples: one more of them at either end.
  CHECK(mistaken_s(found.lost, kLost) < 2 * kSample_s * static_cast<double>(kLost.size()));
}

TEST_CASE("goal losses: a drive that is turned off lets go, and hides no burst before that") {
  const bool duty_law = GENERATE(false, true);
  CAPTURE(duty_law);
  std::vector<double> enable(kSamples, 0);
  std::fill(enable.begin(), enable.begin() + kSamples / 3, 1);
  const std::vector<sim::LostGoals> early(kLost.begin(), kLost.begin() + 3);
  const Joint joint(duty_law ? duty() : impedance(), early, enable);
  const GoalLosses found = joint.find(joint.truth, {}, true);
  CHECK(found.lost.size() == early.size());
  // No more than all five may have above, of which these are three.
  CHECK(mistaken_s(found.lost, early) < (duty_law ? 0.006 : 0.003) * 5);
}

TEST_CASE("goal losses: a recording too short to tell has none") {
  const Joint joint(impedance(), {});
  sim::PendulumInputs few = joint.inputs;
  few.time_s = few.time_s.first(10);
  const std::vector<LossChannel> channels = {
      {LossChannel::kPosition, joint.position_rad, kPositionNoise_rad}};
  CHECK(find_losses(joint.truth, few, joint.start(), channels, {}, 1e-3).lost.empty());
}
