// Symbols: p pressure of the nominal law, Pa.
//   pressure = p / (1 + softness p): it never exceeds 1/softness

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnlistedBearingLimit final : public SoilEffect {
 public:
  explicit UnlistedBearingLimit(std::span<const double> values) : softness_1_Pa_(values[0]) {}

  double strength_N(double force_N, const SoilContact& contact) const override {
    return force_N / (1 + force_N * softness_1_Pa_ / contact.area_m2);
  }

 private:
  double softness_1_Pa_;
};

}  // namespace

EffectInfo unlisted_bearing_limit_effect() {
  return {.name = "unlisted_bearing_limit",
          .plug_in = PlugIn::kTerrain,
          .summary = "the pressure levels off at depth",
          .equation = "pressure = p / (1 + softness p)",
          .source =
              "a stand-in, after Terzaghi: Theoretical Soil Mechanics (1943): general failure at a "
              "limit load",
          .parameters = {{"softness", "1/Pa", 0.0, 1, 1e-6, true, false, {1e-6}}},
          .experiment = "press a small plate as deep as the rig goes",
          .listed = false,
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<UnlistedBearingLimit>(values);
          }};
}

}  // namespace hoof::sim
