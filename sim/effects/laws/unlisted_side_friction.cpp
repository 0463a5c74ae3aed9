// Symbols: z depth, m; U girth of the plate, m; tau friction on the side at depth z, Pa.
//   force = F + U gradient z^2 / 2, from tau = gradient z
//
// The girth is that of a disc of the same area.
#include <cmath>
#include <numbers>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnlistedSideFriction final : public SoilEffect {
 public:
  explicit UnlistedSideFriction(std::span<const double> values) : gradient_Pa_m_(values[0]) {}

  double force_N(double force_N, const SoilContact& contact) const override {
    const double girth_m = 2 * std::sqrt(std::numbers::pi * contact.area_m2);
    return force_N + girth_m * gradient_Pa_m_ * contact.depth_m * contact.depth_m / 2;
  }

 private:
  double gradient_Pa_m_;
};

}  // namespace

EffectInfo unlisted_side_friction_effect() {
  return {.name = "unlisted_side_friction",
          .plug_in = PlugIn::kTerrain,
          .summary = "the plate's side or shaft rubs on the sand",
          .equation = "force = F + girth * gradient * z^2 / 2",
          .source = "a stand-in: sleeve friction of penetrometers",
          .parameters = {{"gradient", "Pa/m", 0.0, 1e9, 2e5, true, false, {2e5}}},
          .experiment = "press a thin and a thick plate of the same area",
          .listed = false,
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<UnlistedSideFriction>(values);
          }};
}

}  // namespace hoof::sim
