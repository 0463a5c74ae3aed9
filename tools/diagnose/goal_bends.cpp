#include "tools/diagnose/goal_bends.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {
namespace {

constexpr double kAgree = 3;

/// Of two ends of a span.
double between(double a, double b) {
  if (a * b <= 0) return 0;
  const double small = std::min(std::abs(a), std::abs(b));
  const double large = std::max(std::abs(a), std::abs(b));
  return large <= kAgree * small ? 0.5 * (a + b) : std::copysign(small, a);
}

}  // namespace

Bends bends(std::span<const double> t, std::span<const double> y) {
  const std::size_t n = y.size();
  std::vector<double> curvature(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double a = t[i] - t[i - 1], b = t[i + 1] - t[i];
    if (!(a > 0) || !(b > 0)) continue;
    curvature[i] = 2 * ((y[i + 1] - y[i]) / b - (y[i] - y[i - 1]) / a) / (a + b);
  }
  Bends result(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double off = 0.5 * (t[i + 1] - t[i]) * between(curvature[i], curvature[i + 1]);
    result[i] = {-off, off};
  }
  return result;
}

GoalBends goal_bends(const Recording& recording) {
  const std::span<const double> t = recording.time_s;
  const auto of = [&](const char* channel) { return bends(t, recording.values(channel)); };
  GoalBends all{of("position_goal"), of("velocity_goal"), of("torque_ff")};
  const auto goal = recording.values("position_goal");
  const auto velocity = recording.values("velocity_goal");
  for (std::size_t i = 0; i + 1 < goal.size() && !velocity.empty(); ++i) {
    if (!(t[i + 1] > t[i])) continue;
    const double slope = (goal[i + 1] - goal[i]) / (t[i + 1] - t[i]);
    const double start = velocity[i] - slope, end = velocity[i + 1] - slope;
    if (start * end < 0) all.position[i] = {start, end};
  }
  return all;
}

}  // namespace hoof::tools
