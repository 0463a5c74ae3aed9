// What a set of presses can tell at most: effects it cannot show, and how far presses that should
// be alike differ.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "tools/diagnose/press_model.h"

namespace hoof::tools {
namespace {

/// Force over depth while the plate goes deeper than ever.
struct LoadingCurve {
  std::vector<double> depth_m, force_N;

  std::optional<double> at(double depth) const {
    const auto after = std::lower_bound(depth_m.begin(), depth_m.end(), depth);
    if (after == depth_m.begin() || after == depth_m.end()) return std::nullopt;
    const auto i = static_cast<std::size_t>(after - depth_m.begin());
    const double share = (depth - depth_m[i - 1]) / (depth_m[i] - depth_m[i - 1]);
    return force_N[i - 1] + share * (force_N[i] - force_N[i - 1]);
  }
};

/// Root mean square of curve `own` less the mean of the others at the same depth.
double off_the_others(const std::vector<LoadingCurve>& curves, std::size_t own) {
  double square_N2 = 0;
  int count = 0;
  for (std::size_t i = 0; i < curves[own].depth_m.size(); ++i) {
    double sum_N = 0;
    int others = 0;
    for (std::size_t other = 0; other < curves.size(); ++other) {
      if (other == own) continue;
      const auto force_N = curves[other].at(curves[own].depth_m[i]);
      if (!force_N) continue;
      sum_N += *force_N;
      ++others;
    }
    if (others == 0) continue;
    square_N2 += std::pow(curves[own].force_N[i] - sum_N / others, 2);
    ++count;
  }
  return count > 0 ? std::sqrt(square_N2 / count) : NAN;
}

}  // namespace

double PressModel::repeat_scatter_N(double width_m) const {
  std::vector<double> setup;
  for (const DoubtfulValue& doubt : doubtful_) setup.push_back(doubt.value);
  std::vector<LoadingCurve> curves;
  for (const Press& press : presses_) {
    if (press.rig != RigKind::kPlateSand) continue;
    const sim::PressBench bench = this->bench(press, setup);
    if (bench.plate.width_m != width_m) continue;
    LoadingCurve curve;
    const auto& forces_N = press.recording.channels.at("force");
    double deepest_m = 0;
    for (std::size_t i = 0; i < forces_N.size(); ++i) {
      const double depth_m = bench.surface_height_m - press.path.height_m[i];
      if (depth_m <= deepest_m || std::isnan(forces_N[i])) continue;
      deepest_m = depth_m;
      curve.depth_m.push_back(depth_m);
      curve.force_N.push_back(forces_N[i]);
    }
    curves.push_back(std::move(curve));
  }
  double square_N2 = 0;
  int count = 0;
  for (std::size_t own = 0; own < curves.size(); ++own) {
    const double off_N = off_the_others(curves, own);
    if (std::isnan(off_N)) continue;
    square_N2 += off_N * off_N;
    ++count;
  }
  return count > 0 ? std::sqrt(square_N2 / count) : NAN;
}

std::vector<QualityNote> PressModel::notes() const {
  std::vector<QualityNote> notes;
  for (const HiddenEffect& hidden : hidden_) {
    notes.push_back({"", "", hidden.effect + " cannot show here: " + hidden.reason, false});
  }
  std::vector<double> setup;
  for (const DoubtfulValue& doubt : doubtful_) setup.push_back(doubt.value);
  std::vector<double> widths_m;
  for (const Press& press : presses_) {
    if (press.rig != RigKind::kPlateSand) continue;
    const double width_m = bench(press, setup).plate.width_m;
    if (std::find(widths_m.begin(), widths_m.end(), width_m) == widths_m.end()) {
      widths_m.push_back(width_m);
    }
  }
  for (const double width_m : widths_m) {
    const double scatter_N = repeat_scatter_N(width_m);
    if (std::isnan(scatter_N)) continue;
    char text[160];
    std::snprintf(text, sizeof text,
                  "presses of the plate with b = %.3g m differ from each other by %.3g N rms at "
                  "the same depth: less no model of sand and rig alone can leave",
                  width_m, scatter_N);
    notes.push_back({"", "force", text, false});
  }
  return notes;
}

}  // namespace hoof::tools
