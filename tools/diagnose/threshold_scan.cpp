#include "tools/diagnose/threshold_scan.h"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/damped_fit.h"

namespace hoof::tools {
namespace {

/// Of the grid, in the logarithm: three places to a factor of two.
const double kStep = std::log(2.0) / 3;
/// Halvings of the step about the best two: to 3 %.
constexpr int kCloser = 3;
constexpr std::size_t kBest = 2;
/// A place that promises less than this share of the best is not fitted.
constexpr double kWorthwhile = 0.05;
constexpr int kIterations = 2, kLastIterations = 5;

bool better(const Fit& a, const Fit& b) {
  return a.objective < b.objective;
}

}  // namespace

int threshold_of(const RigModel& model, const LinearStart& start) {
  const Layout alone(model, {start.effect});
  int found = -1;
  for (int i = 0; i < start.own.size(); ++i) {
    const sim::EffectParameter& p = *alone.of_effect(i).parameter;
    if (i == start.size || i == start.phase || !p.logarithmic || p.starts.size() < 3) continue;
    if (found >= 0) return -1;
    found = i;
  }
  return start.size >= 0 ? found : -1;
}

std::vector<Fit> scan_threshold(const Fitter& fitter, const LinearBase& base,
                                const LinearStart& start, const Fitter::Weights& weights,
                                const ScanTasks& for_all) {
  const Layout alone(fitter.model(), {start.effect});
  const int own = threshold_of(fitter.model(), start);
  const sim::EffectParameter& p = *alone.of_effect(own).parameter;
  const auto [low, high] = std::minmax_element(p.starts.begin(), p.starts.end());

  std::vector<LinearStart> places;
  for (double x = std::log(*low / 2); x < std::log(*high) + kStep; x += kStep) {
    places.push_back(start);
    places.back().own[own] = x;
  }
  std::vector<LinearStep> steps(places.size());
  for_all(places.size(), [&](std::size_t i) { steps[i] = base.beside(places[i]); });
  double most = 0;
  for (const LinearStep& step : steps) most = std::max(most, step.gain);
  std::erase_if(steps, [most](const LinearStep& s) { return !(s.gain > kWorthwhile * most); });

  std::vector<Fit> fits(steps.size());
  const auto coordinate = [&](const Fit& fit) {
    int at = alone.setup_count() + own;
    for (const sim::EffectInfo* effect : fit.effects) {
      if (effect == start.effect) break;
      at += static_cast<int>(effect->parameters.size());
    }
    return at;
  };
  for_all(steps.size(), [&](std::size_t i) {
    const Fit at = base.least_along(steps[i]);
    fits[i] = damped_fit(fitter, at, kIterations, weights, coordinate(at));
  });
  double step = kStep;
  for (int round = 0; round < kCloser && !fits.empty(); ++round) {
    std::stable_sort(fits.begin(), fits.end(), better);
    step *= 0.5;
    std::vector<Fit> closer;
    for (std::size_t i = 0; i < std::min(kBest, fits.size()); ++i) {
      for (const double side : {-step, step}) {
        Fit moved = fits[i];
        const int at = coordinate(moved);
        moved.x[at] += side;
        const bool there = std::any_of(closer.begin(), closer.end(), [&](const Fit& f) {
          return std::abs(f.x[at] - moved.x[at]) < 0.1 * step;
        });
        if (!there) closer.push_back(std::move(moved));
      }
    }
    for_all(closer.size(), [&](std::size_t i) {
      closer[i] = damped_fit(fitter, closer[i], kIterations, weights, coordinate(closer[i]));
    });
    fits.insert(fits.end(), closer.begin(), closer.end());
  }
  std::stable_sort(fits.begin(), fits.end(), better);
  if (fits.size() > kBest) fits.resize(kBest);
  for_all(fits.size(), [&](std::size_t i) {
    fits[i] = damped_fit(fitter, fits[i], kLastIterations, weights);
    fits[i].squares = fitter.squares(fits[i]);
  });
  std::stable_sort(fits.begin(), fits.end(), better);
  return fits;
}

}  // namespace hoof::tools
