// Symbols: F_u force at the deepest point so far, N; F(z) force of loading, N.
//   force = max(F_u - ratio (F_u - F(z)), 0) above the deepest point
//
// Unloading is ratio times as steep as loading between the same depths; loading again follows the
// same line up to the deepest point, and the loading curve from there. Zero once the plate is off.
#include <algorithm>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnloadHysteresis final : public SoilEffect {
 public:
  explicit UnloadHysteresis(std::span<const double> values) : ratio_(values[0]) {}

  double unloading_N(double force_N, double deepest_N, const SoilContact&) const override {
    return std::max(force_N - (ratio_ - 1) * (deepest_N - force_N), 0.0);
  }

 private:
  double ratio_;
};

}  // namespace

EffectInfo unload_hysteresis_effect() {
  return {
      .name = "unload_hysteresis",
      .plug_in = PlugIn::kTerrain,
      .summary = "unloading is steeper than loading: the sand keeps its dent",
      .equation = "force = max(F_u - ratio (F_u - F(z)), 0) above the deepest point",
      .source =
          "Wong: Theory of Ground Vehicles, 4th ed. (2008), 2.4.4, response to repetitive loading",
      .parameters = {{"ratio", "1", 1, 1e3, 5, true, false, {3, 20}}},
      .experiment =
          "press, draw back by half and press again, in steps, with the height recorded all along",
      .make_soil = [](std::span<const double> values) {
        return std::make_unique<UnloadHysteresis>(values);
      }};
}

}  // namespace hoof::sim
