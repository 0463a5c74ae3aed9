#include "tools/diagnose/noise_left.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {
namespace {

/// Residuals count for no less than one in this many.
constexpr double kLeastEffective = 1.0 / 200;

/// Share of samples that are independent: one over one plus twice the sum of the correlations,
/// while those of neighbouring pairs of lags are positive (Geyer, Stat. Sci. 7 (1992) 473).
double effective_share(const std::vector<double>& d) {
  std::vector<double> x;
  for (const double v : d) {
    if (std::isfinite(v)) x.push_back(v);
  }
  const auto n = x.size();
  double power = 0;
  for (const double v : x) power += v * v;
  if (n < 20 || power <= 0) return 1;
  double sum = 0;
  const auto correlation = [&](std::size_t lag) {
    double s = 0;
    for (std::size_t i = 0; i + lag < n; ++i) s += x[i] * x[i + lag];
    return s / power;
  };
  for (std::size_t lag = 1; lag + 1 < n / 4; lag += 2) {
    const double pair = correlation(lag) + correlation(lag + 1);
    if (pair < 0.02) break;
    sum += pair;
  }
  return std::clamp(1 / (1 + 2 * sum), kLeastEffective, 1.0);
}

}  // namespace

void take_noise_left(Fitter& fitter, const Fit& best) {
  auto& groups = fitter.groups();
  std::vector<double> share(groups.size(), 1), variance(groups.size(), 0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Prediction p = fitter.predict(best, groups[g].recording, Rollout::kCorrected);
    share[g] = effective_share(fitter.differences(groups[g], p[groups[g].channel]));
    variance[g] = best.squares[g] / std::max(groups[g].samples, 1.0);
  }
  const auto name = [&fitter](const Group& g) {
    return fitter.model().channels(g.recording)[g.channel];
  };
  for (std::size_t g = 0; g < groups.size(); ++g) {
    double v = 0, e = 0, n = 0;
    for (std::size_t o = 0; o < groups.size(); ++o) {
      const bool alike =
          groups[g].holdout ? !groups[o].holdout && name(groups[o]) == name(groups[g]) : o == g;
      if (!alike) continue;
      v += variance[o], e += share[o], n += 1;
    }
    const double least = kLeastVariance * groups[g].noise * groups[g].noise;
    groups[g].sigma = std::sqrt(std::max(n > 0 ? v / n : 0.0, least));
    groups[g].effective = n > 0 ? e / n : share[g];
  }
}

}  // namespace hoof::tools
