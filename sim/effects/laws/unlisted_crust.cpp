// Symbols: A area of the plate, m2; z depth, m.
//   force = F + A strength (z / depth) exp(1 - z / depth)
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnlistedCrust final : public SoilEffect {
 public:
  explicit UnlistedCrust(std::span<const double> values)
      : strength_Pa_(values[0]), depth_m_(values[1]) {}

  double force_N(double force_N, const SoilContact& contact) const override {
    const double ratio = contact.depth_m / depth_m_;
    return force_N + contact.area_m2 * strength_Pa_ * ratio * std::exp(1 - ratio);
  }

 private:
  double strength_Pa_, depth_m_;
};

}  // namespace

EffectInfo unlisted_crust_effect() {
  return {.name = "unlisted_crust",
          .plug_in = PlugIn::kTerrain,
          .summary = "something near the surface adds to the force and is soon passed",
          .equation = "force = F + A strength (z / depth) exp(1 - z / depth)",
          .source = "a stand-in: crusts, films and loose tops",
          .parameters = {{"strength", "Pa", -1e6, 1e6, 5e3, false, false, {2e3, -2e3}},
                         {"depth", "m", 2e-4, 0.1, 5e-3, true, false, {3e-3, 0.01}}},
          .experiment = "press slowly through the first centimetre, at several places",
          .listed = false,
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<UnlistedCrust>(values);
          }};
}

}  // namespace hoof::sim
