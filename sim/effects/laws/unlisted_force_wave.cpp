// Symbols: z depth, m.
//   force = F (1 + amplitude sin(2 pi z / period + phase))
#include <cmath>
#include <numbers>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnlistedForceWave final : public SoilEffect {
 public:
  explicit UnlistedForceWave(std::span<const double> values)
      : amplitude_(values[0]), period_m_(values[1]), phase_rad_(values[2]) {}

  double strength_N(double force_N, const SoilContact& contact) const override {
    const double angle_rad = 2 * std::numbers::pi * contact.depth_m / period_m_ + phase_rad_;
    return force_N * (1 + amplitude_ * std::sin(angle_rad));
  }

 private:
  double amplitude_, period_m_, phase_rad_;
};

}  // namespace

EffectInfo unlisted_force_wave_effect() {
  return {
      .name = "unlisted_force_wave",
      .plug_in = PlugIn::kTerrain,
      .summary = "the force comes and goes with depth: thin layers, or sand that slips in steps",
      .equation = "force = F (1 + amplitude sin(2 pi z / period + phase))",
      .source = "a stand-in: stick and slip of dense sand",
      .parameters = {{"amplitude", "1", 0.0, 1, 0.1, true, false, {0.05}},
                     {"period", "m", 5e-4, 0.1, 0.01, true, false, {2e-3, 4e-3, 8e-3, 0.016}},
                     {"phase", "rad", -std::numbers::pi, std::numbers::pi, 2, false, true, {}}},
      .experiment =
          "press at half and at double the speed: layers stay at their depth, stick and slip does "
          "not",
      .listed = false,
      .make_soil = [](std::span<const double> values) {
        return std::make_unique<UnlistedForceWave>(values);
      }};
}

}  // namespace hoof::sim
