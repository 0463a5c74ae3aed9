// Which effects a set of presses can show at all, and the operating regions of a press.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tools/diagnose/press_model.h"

namespace hoof::tools {
namespace {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

std::string text_of(const char* format, double value) {
  char text[80];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Depths, the deepest so far and downward speeds, one entry per sample.
struct Depths {
  std::vector<double> depth_m, deepest_m;
};

Depths depths_of(const sim::PressPath& path, double surface_height_m) {
  Depths result;
  double deepest_m = 0;
  for (const double height_m : path.height_m) {
    const double depth_m = surface_height_m - height_m;
    deepest_m = depth_m > 0 ? std::max(deepest_m, depth_m) : 0.0;
    result.depth_m.push_back(depth_m);
    result.deepest_m.push_back(deepest_m);
  }
  return result;
}

/// Share of the deepest point by which a plate must draw back to show how the sand unloads.
constexpr double kDrawnBack = 0.02;

}  // namespace

/// What all presses of sand together span.
struct PressModel::Span {
  bool sand = false, block = false;
  double narrowest_m = INFINITY, widest_m = 0;
  double slow_m_s = 0, fast_m_s = 0;  // 10 and 90 % of the samples going down in the sand
  int first_press = 0, last_press = 0;
  int unloading = 0;  // samples
};

PressModel::Span PressModel::span() const {
  Span span;
  std::vector<double> speeds;
  std::vector<double> setup;
  for (const DoubtfulValue& doubt : doubtful_) setup.push_back(doubt.value);
  for (const Press& press : presses_) {
    if (press.rig == RigKind::kRigidPress) {
      span.block = true;
      continue;
    }
    const sim::PressBench bench = this->bench(press, setup);
    span.narrowest_m = std::min(span.narrowest_m, bench.plate.width_m);
    span.widest_m = std::max(span.widest_m, bench.plate.width_m);
    const Depths depths = depths_of(press.path, bench.surface_height_m);
    for (std::size_t i = 0; i < depths.depth_m.size(); ++i) {
      if (depths.depth_m[i] <= 0) continue;
      if (!span.sand) span.first_press = press.path.press[i];
      span.sand = true;
      span.last_press = press.path.press[i];
      if (press.path.speed_m_s[i] > 0) speeds.push_back(press.path.speed_m_s[i]);
      if (depths.depth_m[i] < (1 - kDrawnBack) * depths.deepest_m[i]) ++span.unloading;
    }
  }
  span.slow_m_s = quantile(speeds, 0.1);
  span.fast_m_s = quantile(speeds, 0.9);
  return span;
}

/// Empty where these presses can show the effect.
std::string PressModel::why_hidden(const sim::EffectInfo& effect, const Span& span) {
  const bool of_rig = effect.plug_in == sim::PlugIn::kRig;
  if (!span.sand && !(of_rig && span.block)) return "no press on sand";
  constexpr double kRatio = 1.02;      // of plate sizes
  constexpr double kSpeedRatio = 1.2;  // of the fast samples to the slow
  constexpr int kSamples = 5;
  if (effect.name == "plate_size_law" && span.widest_m < kRatio * span.narrowest_m) {
    return "one plate size: it cannot be told from k_phi";
  }
  if (effect.name == "packing_change" && span.first_press == span.last_press) {
    return "one press: there is nothing to drift";
  }
  if (effect.name == "rate_dependence" && span.fast_m_s < kSpeedRatio * span.slow_m_s) {
    return "one speed: it cannot be told from k_phi";
  }
  if (effect.name == "unload_hysteresis" && span.unloading < kSamples) {
    return "the plate is not drawn back within the recordings";
  }
  return "";
}

void PressModel::choose_effects() {
  const Span span = this->span();
  for (const sim::EffectInfo& effect : sim::effect_catalogue()) {
    if (!effect.make_soil) continue;
    // A plate is not sheared and has no spines.
    if (effect.name == "slip_sinkage" || effect.name == "spine_wear") continue;
    const std::string reason = why_hidden(effect, span);
    if (reason.empty()) {
      effects_.push_back(&effect);
    } else if (effect.listed) {
      hidden_.push_back({std::string(effect.name), reason});
    }
  }
}

std::vector<RigModel::Condition> PressModel::conditions(int index) const {
  const Press& press = this->press(index);
  std::vector<Condition> result;
  const std::size_t count = press.compared.size();
  const auto add = [&](const std::string& text, const std::function<bool(std::size_t)>& holds) {
    Condition condition = {.text = text, .holds = std::vector<bool>(count)};
    for (std::size_t i = 0; i < count; ++i) condition.holds[i] = press.compared[i] && holds(i);
    result.push_back(std::move(condition));
  };
  if (press.rig == RigKind::kRigidPress) {
    const double largest_N = *std::max_element(press.force_N.begin(), press.force_N.end());
    for (const double share : {0.25, 0.5, 0.75}) {
      add(text_of("force > %.3g", share * largest_N),
          [&](std::size_t i) { return press.force_N[i] > share * largest_N; });
    }
    return result;
  }
  std::vector<double> setup;
  for (const DoubtfulValue& doubt : doubtful_) setup.push_back(doubt.value);
  const sim::PressBench bench = this->bench(press, setup);
  const Depths depths = depths_of(press.path, bench.surface_height_m);
  for (const double depth_m : condition_depths_m()) {
    add(text_of("surface_height - position > %.3g", depth_m),
        [&](std::size_t i) { return depths.depth_m[i] > depth_m; });
    add(text_of("0 < surface_height - position < %.3g", depth_m),
        [&](std::size_t i) { return depths.depth_m[i] > 0 && depths.depth_m[i] < depth_m; });
  }
  const auto unloads = [&](std::size_t i) {
    return depths.depth_m[i] > 0 && depths.depth_m[i] < (1 - kDrawnBack) * depths.deepest_m[i];
  };
  add("unloading (position above its lowest so far)", unloads);
  add("loading (position at its lowest so far)",
      [&](std::size_t i) { return depths.depth_m[i] > 0 && !unloads(i); });
  const Span span = this->span();
  const double middle_m_s = std::sqrt(std::max(span.slow_m_s * span.fast_m_s, 0.0));
  add(text_of("downward speed > %.3g", middle_m_s),
      [&](std::size_t i) { return depths.depth_m[i] > 0 && press.path.speed_m_s[i] > middle_m_s; });
  add(text_of(press.diameter.known ? "diameter = %.3g" : "smaller side = %.3g",
              press.diameter.known ? 2 * bench.plate.width_m : bench.plate.width_m),
      [&](std::size_t i) { return depths.depth_m[i] > 0; });
  return result;
}

/// Ten depths that stand for the same in all recordings: equal steps to the deepest point.
std::vector<double> PressModel::condition_depths_m() const {
  std::vector<double> setup;
  for (const DoubtfulValue& doubt : doubtful_) setup.push_back(doubt.value);
  double deepest_m = 0;
  for (const Press& press : presses_) {
    if (press.rig == RigKind::kRigidPress) continue;
    const double surface_m = value(press.surface_height, setup);
    for (const double height_m : press.path.height_m) {
      deepest_m = std::max(deepest_m, surface_m - height_m);
    }
  }
  std::vector<double> depths_m;
  for (int step = 1; step < 10; ++step) depths_m.push_back(deepest_m * step / 10);
  return depths_m;
}

}  // namespace hoof::tools
