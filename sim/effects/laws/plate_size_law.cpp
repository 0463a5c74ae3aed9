// Symbols: b smaller dimension (radius of a disc), m.
//   pressure = (k_c/b + k_phi) z^n (b/b0)^exponent
//
// b0 = 50 mm is a reference alone: another would be taken up by k_c and k_phi together.
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class PlateSizeLaw final : public SoilEffect {
 public:
  explicit PlateSizeLaw(std::span<const double> values) : exponent_(values[0]) {}

  double strength_N(double force_N, const SoilContact& contact) const override {
    constexpr double kReference_m = 0.05;
    return force_N * std::pow(contact.width_m / kReference_m, exponent_);
  }

 private:
  double exponent_;
};

}  // namespace

EffectInfo plate_size_law_effect() {
  return {.name = "plate_size_law",
          .plug_in = PlugIn::kTerrain,
          .summary = "pressure depends on the plate's size beyond Bekker's two terms",
          .equation = "pressure = (k_c/b + k_phi) z^n (b/b0)^exponent",
          .source =
              "Meirion-Griffith, Spenko: J. Terramechanics 48 (2011) 149, pressure with diameter^m",
          .parameters = {{"exponent", "1", -3, 3, 0.4, false, false, {0.2, -0.2}}},
          .experiment =
              "press plates of at least four sizes over a ratio of five, each on fresh sand, three "
              "times",
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<PlateSizeLaw>(values);
          }};
}

}  // namespace hoof::sim
