#include "tools/diagnose/refit.h"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/damped_fit.h"

namespace hoof::tools {
namespace {

/// Of a fit's own size, where an effect is tried weaker and stronger.
constexpr double kWeaker = 0.8, kStronger = 1.25;
/// Starts that are followed to the end, of those that were fitted roughly.
constexpr std::size_t kFollowed = 2;
constexpr int kUntilIterations = 4, kRoughIterations = 3;

/// A start, and the coordinate that stays until the setup has found its place; -1: none.
struct Start {
  Eigen::VectorXd x;
  int held = -1;
};

std::vector<Start> starts_of(const Layout& layout, const Eigen::VectorXd& found) {
  Eigen::VectorXd stated = found;
  stated.head(layout.setup_count()).setZero();
  std::vector<Start> starts = {{stated}, {0.5 * (stated + found)}, {found}};
  int own = layout.setup_count();
  for (const sim::EffectInfo* effect : layout.effects()) {
    // The first of an effect's parameters is its strength.
    const bool by_log = effect->parameters[0].logarithmic;
    for (const double factor : {kWeaker, kStronger}) {
      Eigen::VectorXd x = stated;
      x[own] = by_log ? x[own] + std::log(factor) : x[own] * factor;
      starts.push_back({x, own});
    }
    own += static_cast<int>(effect->parameters.size());
  }
  return starts;
}

/// The setup first, by what of each recording is followed; then everything.
Fit rough(const Fitter& fitter, const Effects& effects, const Start& start,
          const Fitter::Weights& weights) {
  Fit fit;
  fit.effects = effects;
  fit.x = start.x;
  const auto until = fitter.followed_until(fit);
  Fitter::Weights some = fitter.roomy_weights(fitter.squares(fit, until), 1);
  some.until = until;
  fit = damped_fit(fitter, fit, kUntilIterations, some, start.held);
  return damped_fit(fitter, fit, kRoughIterations, weights);
}

}  // namespace

Fit settle(const Fitter& fitter, Fit fit, int iterations) {
  for (const double share : {0.5, 0.15}) {
    const auto weights = fitter.roomy_weights(fitter.squares(fit), share);
    fit = fitter.fit(fit.effects, fit.x, 6, weights, 1e-3);
  }
  return fitter.fit(fit.effects, fit.x, iterations, fitter.weights());
}

Fit fit_again(const Fitter& fitter, const Fit& found, int iterations) {
  const Layout layout(fitter.model(), found.effects);
  const auto weights = fitter.roomy_weights(fitter.squares(found), 0.5);
  std::vector<Fit> fits;
  for (const Start& start : starts_of(layout, found.x)) {
    fits.push_back(rough(fitter, found.effects, start, weights));
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const Fit& a, const Fit& b) { return a.objective < b.objective; });
  Fit best = found;
  for (std::size_t i = 0; i < std::min(kFollowed, fits.size()); ++i) {
    Fit fit = settle(fitter, fits[i], iterations);
    if (fit.objective < best.objective) best = std::move(fit);
  }
  return best;
}

}  // namespace hoof::tools
