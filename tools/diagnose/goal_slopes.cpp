#include "tools/diagnose/goal_slopes.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {
namespace {

/// A cubic is monotone where both slopes are within this many times its secant.
constexpr double kMonotone = 3;

double secant(std::span<const double> t, std::span<const double> y, std::size_t i) {
  return t[i + 1] > t[i] ? (y[i + 1] - y[i]) / (t[i + 1] - t[i]) : 0;
}

}  // namespace

std::vector<double> limited_slopes(std::span<const double> t, std::span<const double> y) {
  const std::size_t n = y.size();
  std::vector<double> slopes(n, 0.0);
  if (n < 2) return slopes;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = secant(t, y, i - 1), after = secant(t, y, i);
    const double a = t[i] - t[i - 1], b = t[i + 1] - t[i];
    // Of the parabola through the three.
    const double slope = a + b > 0 ? (b * before + a * after) / (a + b) : 0;
    const double most = kMonotone * std::min(std::abs(before), std::abs(after));
    slopes[i] = std::clamp(slope, -most, most);
  }
  // At the ends the parabola goes on.
  const auto end = [](double secant, double inner) {
    return secant * std::clamp(secant != 0 ? 2 - inner / secant : 0, 0.0, kMonotone);
  };
  const double first = secant(t, y, 0), last = secant(t, y, n - 2);
  slopes.front() = end(first, n > 2 ? slopes[1] : first);
  slopes.back() = end(last, n > 2 ? slopes[n - 2] : last);
  return slopes;
}

GoalSlopes goal_slopes(const Recording& recording) {
  GoalSlopes slopes;
  const std::span<const double> t = recording.time_s;
  const auto goal = recording.values("position_goal");
  const auto velocity = recording.values("velocity_goal");
  if (!goal.empty()) slopes.position = limited_slopes(t, goal);
  if (!velocity.empty()) slopes.velocity = limited_slopes(t, velocity);
  const auto torque = recording.values("torque_ff");
  if (!torque.empty()) slopes.torque = limited_slopes(t, torque);
  const auto fits = [](double v, double s) {
    return v * s > 0 && std::abs(v) <= kMonotone * std::abs(s);
  };
  for (std::size_t i = 0; i < slopes.position.size() && !velocity.empty(); ++i) {
    const bool before = i == 0 || fits(velocity[i], secant(t, goal, i - 1));
    const bool after = i + 1 == goal.size() || fits(velocity[i], secant(t, goal, i));
    if (before && after) slopes.position[i] = velocity[i];
  }
  return slopes;
}

}  // namespace hoof::tools
