#include "tools/diagnose/goal_losses.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {
namespace {

constexpr int kOldest = 80;         // samples
constexpr int kMostLag = 12;        // samples that all goals may be late
constexpr double kBurst = 10;       // log probability that one begins, at a sample
constexpr double kMostSquare = 25;  // a sample that fits nothing counts no more than this
constexpr int kLeastBursts = 3;
constexpr double kLeastGain = 40;

/// Half the square of what is left at sample i for goals `age` samples old, all of them `lag` late.
double half_square(const GoalEvidence& e, std::size_t i, int age, int lag) {
  if (!std::isfinite(e.torque_Nm[i])) return 0;
  const auto old = static_cast<std::size_t>(age + lag);
  const std::size_t k = i > old ? i - old : 0;
  const double expected = std::clamp(e.base_Nm[i] + e.goal_Nm[k], -e.limit_Nm, e.limit_Nm);
  // The goal that was taken over lies anywhere between two samples.
  const double slack = e.goal_Nm[k] - e.goal_Nm[k > 0 ? k - 1 : 0];
  const double variance = e.noise_Nm * e.noise_Nm + slack * slack / 3;
  const double r = e.torque_Nm[i] - expected;
  return 0.5 * std::min(r * r / variance, kMostSquare);
}

}  // namespace

namespace {

GoalLosses find_losses(const GoalEvidence& e, int lag, double& least) {
  const std::size_t n = e.torque_Nm.size();
  GoalLosses losses;
  if (n < 20) return losses;
  std::vector<double> cost(kOldest + 1, 1e300);
  std::vector<std::vector<int>> from(n, std::vector<int>(kOldest + 1, 0));
  cost[0] = half_square(e, 0, 0, lag);
  double fresh = cost[0];
  for (std::size_t i = 1; i < n; ++i) {
    std::vector<double> next(kOldest + 1, 1e300);
    const auto best = std::min_element(cost.begin(), cost.end());
    next[0] = *best + half_square(e, i, 0, lag);
    from[i][0] = static_cast<int>(best - cost.begin());
    fresh += half_square(e, i, 0, lag);
    const int oldest = std::min<int>(kOldest, static_cast<int>(i));
    for (int age = 1; age <= oldest; ++age) {
      const double before = cost[age - 1] + (age == 1 ? kBurst : 0);
      if (before < 1e299) next[age] = before + half_square(e, i, age, lag);
      from[i][age] = age - 1;
    }
    cost = std::move(next);
  }
  int age = static_cast<int>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  least = cost[age];
  losses.gain = fresh - least;
  std::vector<int> ages(n);
  for (std::size_t i = n; i-- > 0;) {
    ages[i] = age;
    age = from[i][age];
  }
  int lost = 0, lost_before_lost = 0;
  for (std::size_t i = 0; i < n; ++i) {
    losses.lost.push_back(ages[i] > 0);
    lost += ages[i] > 0 ? 1 : 0;
    if (ages[i] == 1) ++losses.bursts;
    if (ages[i] > 1) ++lost_before_lost;
  }
  losses.lost_share = lost / static_cast<double>(n);
  losses.stays_lost = lost > 0 ? lost_before_lost / static_cast<double>(lost) : 0;
  if (losses.bursts < kLeastBursts || losses.gain < kLeastGain) losses.lost.clear();
  return losses;
}

}  // namespace

GoalLosses find_losses(const GoalEvidence& evidence) {
  GoalLosses best;
  double least = 1e300;
  for (int lag = 0; lag <= kMostLag; ++lag) {
    double cost = 1e300;
    GoalLosses losses = find_losses(evidence, lag, cost);
    if (cost < least) least = cost, best = std::move(losses);
  }
  return best;
}

}  // namespace hoof::tools
