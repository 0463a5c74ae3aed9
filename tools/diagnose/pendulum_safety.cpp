#include "tools/diagnose/pendulum_safety.h"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/noise.h"
#include "tools/diagnose/series.h"

namespace hoof::tools {
namespace {

constexpr double kSlopeSpan_s = 0.02;

double step_of(const Recording& r) {
  Series steps;
  for (std::size_t i = 1; i < r.time_s.size(); ++i) steps.push_back(r.time_s[i] - r.time_s[i - 1]);
  return median(steps);
}

/// A goal that changes by five samples' way at the largest speed was not led there.
double largest_jump(const Recording& r, double speed_rad_s) {
  if (!r.has("position_goal")) return 0;
  const auto& goal = r.channels.at("position_goal");
  double jump = 0;
  for (std::size_t i = 1; i < goal.size(); ++i) {
    const double change = std::abs(goal[i] - goal[i - 1]);
    const double led = 5 * speed_rad_s * (r.time_s[i] - r.time_s[i - 1]);
    if (change > led) jump = std::max(jump, change);
  }
  return jump;
}

}  // namespace

PendulumSafety pendulum_safety(const std::vector<DataSet>& sets) {
  PendulumSafety safe;
  std::vector<const Recording*> recordings;
  for (const DataSet& set : sets) {
    for (const Recording& r : set.recordings) recordings.push_back(&r);
  }
  Series positions, goals, speeds;
  const auto append = [](Series& all, const Series& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  for (const Recording* recording : recordings) {
    const Recording& r = *recording;
    append(positions, r.channels.at("position"));
    if (r.has("position_goal")) append(goals, r.channels.at("position_goal"));
    const double span_s = std::max(kSlopeSpan_s, 2.5 * step_of(r));
    for (const double v : slopes(r.time_s, r.channels.at("position"), span_s)) {
      speeds.push_back(std::abs(v));
    }
    if (r.has("torque")) {
      for (const double v : valid_of(r.channels.at("torque"))) {
        safe.torque_Nm = std::max(safe.torque_Nm, std::abs(v));
      }
    }
  }
  safe.torque_driven = recordings.front()->setup.law == DriveLaw::kTorque;
  safe.position_low_rad = quantile(positions, 0.001);
  safe.position_high_rad = quantile(positions, 0.999);
  const Series& led = safe.torque_driven || valid_of(goals).empty() ? positions : goals;
  safe.low_rad = quantile(led, 0.001);
  safe.high_rad = quantile(led, 0.999);
  safe.speed_rad_s = quantile(speeds, 0.99);
  for (const Recording* r : recordings) {
    safe.jump_rad = std::max(safe.jump_rad, largest_jump(*r, safe.speed_rad_s));
  }
  safe.step_s = step_of(*recordings.front());
  return safe;
}

}  // namespace hoof::tools
