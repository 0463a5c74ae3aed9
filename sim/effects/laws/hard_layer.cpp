// Symbols: F(z) nominal force at depth z, N; d depth of the layer, m.
//   force = F(d) + ratio (F(z) - F(d)) where z > d
//
// The stiffness dF/dz is multiplied below d, so that the force is continuous. ratio > 1: a firm
// layer; ratio < 1: loose sand under a crust.
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class HardLayer final : public SoilEffect {
 public:
  explicit HardLayer(std::span<const double> values) : depth_m_(values[0]), ratio_(values[1]) {}

  double strength_N(double force_N, const SoilContact& contact) const override {
    if (contact.depth_m <= depth_m_) return force_N;
    const double at_layer_N = contact.stiffness_N_m * std::pow(depth_m_, contact.exponent);
    return force_N + (ratio_ - 1) * (force_N - at_layer_N);
  }

 private:
  double depth_m_, ratio_;
};

}  // namespace

EffectInfo hard_layer_effect() {
  return {
      .name = "hard_layer",
      .plug_in = PlugIn::kTerrain,
      .summary = "below some depth the ground is stiffer, or softer",
      .equation = "force = F(d) + ratio (F(z) - F(d)) where z > d",
      .source = "Lyasko: J. Terramechanics 47 (2010) 1, LSA model with the depth of a firm layer",
      .parameters = {{"depth", "m", 1e-3, 1, 0.02, true, false, {0.005, 0.01, 0.02, 0.04}},
                     {"ratio", "1", 0.05, 20, 3, true, false, {2.5, 0.4}}},
      .experiment =
          "press two plates of different size well beyond the suspected depth: a layer stays at "
          "its depth",
      .make_soil = [](std::span<const double> values) {
        return std::make_unique<HardLayer>(values);
      }};
}

}  // namespace hoof::sim
