// What a recording leaves open beside the machine's numbers: when its inputs acted, and how fast
// the joint was at its first sample.
#include <algorithm>
#include <limits>

#include "tools/diagnose/pendulum_model.h"

namespace hoof::tools {
namespace {

using sim::PendulumLaw;

/// Doubt of when inputs act: of a control period, and of the time between samples.
constexpr double kPeriodShare = 0.2;
constexpr double kSampleShare = 0.05;
constexpr double kSwitchShare = 0.3;  // uniform over a sample
/// And no more than this many of its sigmas: what is later still is a delay.
constexpr double kMostTiming = 2;
/// The polynomial of the first samples is chosen by looking at them: its own deviation is too small
/// by about this.
constexpr double kChosen = 4;

}  // namespace

/// Where within its period a drive takes a goal over, and whether a log holds the goal of then or
/// of now, is not known: a clock that is a share of a period off is no physics.
void PendulumModel::add_timing(Run& run) {
  const auto& t = run.recording->time_s;
  const double sample_s = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  const bool torque = run.settings.law == PendulumLaw::kTorque;
  const std::string name = torque ? "torque_timing" : "goal_timing";
  const double sigma = kPeriodShare * run.settings.control_period_s + kSampleShare * sample_s;
  run.timing = shared_doubt({name, 0, sigma, -kMostTiming * sigma, kMostTiming * sigma, -1, false});
  add_switch_timing(run, sample_s);
}

/// A drive turns off somewhere between two samples; a swing that begins there remembers when.
void PendulumModel::add_switch_timing(Run& run, double sample_s) {
  const auto enable = run.recording->values("enable");
  const auto turns = [](double a, double b) { return (a > 0.5) != (b > 0.5); };
  const bool switched = std::adjacent_find(enable.begin(), enable.end(), turns) != enable.end();
  if (!switched || run.recording->holdout) return;
  const double sigma = kSwitchShare * sample_s;
  run.switch_timing = static_cast<int>(doubtful_.size());
  doubtful_.push_back({"switch_timing@" + run.recording->name, 0, sigma, -kMostTiming * sigma,
                       kMostTiming * sigma, static_cast<int>(runs_.size()), false});
}

/// A loop that is soft, or at its limit, remembers the speed it began with for long; a few samples
/// tell it to a few per cent only. A rollout that is drawn to what was measured needs no such help.
void PendulumModel::add_start_speed(Run& run) {
  const bool drawn = run.correction.angle > 0;
  if (!(run.start_speed_doubt_rad_s > 0) || drawn || run.recording->holdout) return;
  constexpr double kAny = std::numeric_limits<double>::infinity();
  run.start_speed = static_cast<int>(doubtful_.size());
  doubtful_.push_back({"start_speed@" + run.recording->name, run.fitted_start.velocity_rad_s,
                       kChosen * run.start_speed_doubt_rad_s, -kAny, kAny,
                       static_cast<int>(runs_.size()), false});
}

/// A recorded torque has noise that the joint never felt. How much of it is noise is for the
/// recordings to say: else whatever is slow to follow a torque, a lag or a soft joint, would be
/// found for smoothing it.
void PendulumModel::add_smoothing(Run& run) {
  if (smoothed_Nm_.count(run.recording) == 0) return;
  run.smoothing = shared_doubt({"torque_smoothing", static_cast<double>(kUsualSmoothing), 1, 0,
                                static_cast<double>(kSmoothingSpans.size() - 1), -1, false});
}

/// Between two of the spans, the mean of both by how near they are.
std::vector<double> PendulumModel::smoothed_torque_Nm(const Run& run, double smoothing) const {
  const auto& all = smoothed_Nm_.at(run.recording);
  const auto less = std::min(static_cast<std::size_t>(smoothing), all.size() - 2);
  const double share = smoothing - static_cast<double>(less);
  std::vector<double> torque_Nm = all[less];
  for (std::size_t i = 0; i < torque_Nm.size(); ++i) {
    torque_Nm[i] += share * (all[less + 1][i] - torque_Nm[i]);
  }
  return torque_Nm;
}

}  // namespace hoof::tools
