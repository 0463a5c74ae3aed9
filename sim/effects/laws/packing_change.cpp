// Symbols: i presses that went before.
//   stiffness = nominal (1 + drift i)
//
// Presses are counted in the order of the data set, several within a recording where the plate
// leaves the sand between them.
#include <algorithm>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class PackingChange final : public SoilEffect {
 public:
  explicit PackingChange(std::span<const double> values) : drift_(values[0]) {}

  double strength_N(double force_N, const SoilContact& contact) const override {
    return force_N * std::max(1 + drift_ * contact.press, 0.0);
  }

 private:
  double drift_;
};

}  // namespace

EffectInfo packing_change_effect() {
  return {.name = "packing_change",
          .plug_in = PlugIn::kTerrain,
          .summary = "the sand is packed denser, or looser, by every press",
          .equation = "stiffness = nominal (1 + drift i)",
          .source =
              "Gravish, Umbanhowar, Goldman: Phys. Rev. Lett. 105 (2010) 128301, drag force and "
              "packing",
          .parameters = {{"drift", "1 per press", -0.5, 2, 0.05, false, false, {0.04, -0.04}}},
          .experiment = "press the same plate ten times without preparing the sand anew",
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<PackingChange>(values);
          }};
}

}  // namespace hoof::sim
