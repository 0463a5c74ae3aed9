// Which goals a drive never had, as the recordings tell.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "tools/diagnose/noise.h"
#include "tools/diagnose/pendulum_keys.h"
#include "tools/diagnose/pendulum_model.h"

namespace hoof::tools {
namespace {

/// Settings that shape how a joint follows its goals.
constexpr std::array<std::string_view, 7> kDoubted = {
    "payload_mass", "arm_mass", "armature", "coulomb", "viscous", "kt", "resistance"};

}  // namespace

void PendulumModel::look_for_losses(Run& run) const {
  const Recording& recording = *run.recording;
  if (run.settings.law == sim::PendulumLaw::kTorque || recording.planned) return;
  const auto& t = recording.time_s;
  std::vector<LossChannel> channels;
  std::vector<double> torque;
  for (const std::string& name : run.channels) {
    const auto& values = recording.channels.at(name);
    if (name == "position") {
      channels.push_back({LossChannel::kPosition, values, estimate_noise(t, values)});
    } else if (name == "velocity") {
      channels.push_back({LossChannel::kVelocity, values, estimate_noise(t, values)});
    } else if (name == "torque") {
      channels.push_back({LossChannel::kTorque, values, estimate_noise(t, values)});
    } else if (name == "current" && !run.predicts("torque")) {
      for (const double v : values) torque.push_back(run.settings.kt_Nm_A * v);
      channels.push_back({LossChannel::kTorque, torque, estimate_noise(t, torque)});
    }
  }
  sim::PendulumInputs inputs = run.inputs;
  inputs.position_goal_bend_rad_s = run.goal_bends.position;
  inputs.velocity_goal_bend_rad_s2 = run.goal_bends.velocity;
  inputs.torque_ff_bend_Nm_s = run.goal_bends.torque;
  std::vector<LossDoubt> doubts;
  for (const PendulumKey& key : kPendulumKeys) {
    const auto doubt = run.doubts.find(key.name);
    const bool doubted = std::find(kDoubted.begin(), kDoubted.end(), key.name) != kDoubted.end();
    if (!doubted || doubt == run.doubts.end()) continue;
    doubts.push_back({key.member, doubtful_[doubt->second].sigma});
  }
  run.losses = find_losses(run.settings, inputs, run.start, channels, doubts, run.longest_step_s);
}

/// Few bursts of little weight are what noise and a coarse look at the law make; many that explain
/// little of what the loop leaves are made by some other physics. Of 29 concealed plants that lose
/// goals (seeds 88001, 88002) 27 have more than 0.48 explained and one 0.23, held-out recordings
/// with them; of 15 others with bursts six have less than 0.12.
void PendulumModel::doubt_losses() {
  constexpr std::size_t kLeastBursts = 3;
  constexpr double kLeastGain = 40, kLeastShare = 0.15;
  std::size_t bursts = 0;
  double gain = 0, without = 0;
  for (const Run& run : runs_) {
    if (run.recording->holdout || !run.losses) continue;
    bursts += run.losses->lost.size();
    gain += run.losses->gain;
    without += run.losses->without;
  }
  const bool some = bursts >= kLeastBursts && gain >= kLeastGain;
  if (some && gain >= kLeastShare * without) return;
  for (Run& run : runs_) run.losses.reset();
}

double PendulumModel::complexity(const sim::EffectInfo& effect) const {
  if (effect.name != "frame_loss") return 0;
  // Each burst was placed, and given a length, by looking at the recording.
  double sum = 0;
  for (const Run& run : runs_) {
    if (run.recording->holdout || !run.losses) continue;
    const auto samples = static_cast<double>(run.inputs.time_s.size());
    sum += static_cast<double>(run.losses->lost.size()) * std::log(samples);
  }
  return sum;
}

std::vector<RigModel::Counted> PendulumModel::counted(const sim::EffectInfo& effect) const {
  if (effect.name != "frame_loss") return {};
  double periods = 0, lost = 0, bursts = 0;
  for (const Run& run : runs_) {
    if (run.recording->holdout || !run.losses) continue;
    const double span = run.inputs.time_s.back() - run.inputs.time_s.front();
    const double period = run.settings.control_period_s > 0
                              ? run.settings.control_period_s
                              : span / static_cast<double>(run.inputs.time_s.size() - 1);
    periods += span / period;
    lost += run.losses->lost_s() / period;
    bursts += static_cast<double>(run.losses->lost.size());
  }
  if (bursts < 1) return {};
  const double p = bursts / std::max(periods - lost, 1.0), burst = std::max(lost / bursts, 1.0);
  // Chance in how many bursts there were; and those that change the goal by less than the noise are
  // not seen, or not to their end: of 24 numbers on concealed plants (seed 88001) five were off by
  // 1.4 to 1.7 times where chance alone allowed 1.2 to 1.4.
  constexpr double kMisread = 0.35;
  const double wide = std::hypot(1.96 / std::sqrt(bursts), kMisread);
  return {{0, p, p * std::exp(-wide), p * std::exp(wide)},
          {1, burst, std::max(burst * std::exp(-wide), 1.0), burst * std::exp(wide)}};
}

}  // namespace hoof::tools
