// Symbols: A area of the plate, m2; z depth, m.
//   force = F + strength A min(z / z0, 1)
//
// A constant strength over the area: what moist or fine sand bears before depth gives it any. It
// ramps in over the first z0 = 0.1 mm, so that the force is continuous: less than any press
// resolves. Pressed only: a plate that is drawn out is not held (force is never tension).
#include <algorithm>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class Cohesion final : public SoilEffect {
 public:
  explicit Cohesion(std::span<const double> values) : strength_Pa_(values[0]) {}

  double force_N(double force_N, const SoilContact& contact) const override {
    constexpr double kRamp_m = 0.1e-3;
    return force_N + strength_Pa_ * contact.area_m2 * std::min(contact.depth_m / kRamp_m, 1.0);
  }

 private:
  double strength_Pa_;
};

}  // namespace

EffectInfo cohesion_effect() {
  return {.name = "cohesion",
          .plug_in = PlugIn::kTerrain,
          .summary = "the sand has a strength of its own at no depth: moisture, fines or adhesion",
          .equation = "force = F + strength A min(z / z0, 1)",
          .source =
              "Terzaghi: Theoretical Soil Mechanics (1943), cohesion term c N_c of bearing "
              "capacity; Reece: Proc. IMechE 180 (1965) 45",
          .parameters = {{"strength", "Pa", 0.0, 1e6, 2e3, true, false, {1e3}}},
          .experiment = "press slowly into the first millimetres, with plates of two areas",
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<Cohesion>(values);
          }};
}

}  // namespace hoof::sim
