// Symbols: F resistance of all kinds, N; v speed downward, m/s.
//   force = F (1 + coefficient v)
//
// The contract allows a factor or an inertial term; this is the factor, as its parameter's unit s/m
// says. It multiplies the whole resistance. Going up counts as no speed: sand that is left behind
// neither helps nor hinders. A negative coefficient is sand that weakens with speed.
#include <algorithm>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class RateDependence final : public SoilEffect {
 public:
  explicit RateDependence(std::span<const double> values) : coefficient_s_m_(values[0]) {}

  double force_N(double force_N, const SoilContact& contact) const override {
    return force_N * std::max(1 + coefficient_s_m_ * std::max(contact.speed_m_s, 0.0), 0.0);
  }

 private:
  double coefficient_s_m_;
};

}  // namespace

EffectInfo rate_dependence_effect() {
  return {.name = "rate_dependence",
          .plug_in = PlugIn::kTerrain,
          .summary = "the faster the plate goes down, the larger the force",
          .equation = "force = F (1 + coefficient v)",
          .source =
              "Grahn: J. Terramechanics 28 (1991) 339, penetration velocity in the "
              "pressure-sinkage law",
          .parameters = {{"coefficient", "s/m", -1e3, 1e4, 20, false, false, {15, -15}}},
          .experiment =
              "press the same plate at two speeds a factor of ten apart, on equally prepared sand",
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<RateDependence>(values);
          }};
}

}  // namespace hoof::sim
