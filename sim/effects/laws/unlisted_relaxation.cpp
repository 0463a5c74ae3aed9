// Symbols: F force of the sand, N; x what has relaxed, N.
//   force = F - x,  time_constant dx/dt = share F - x
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnlistedRelaxation final : public SoilEffect {
 public:
  explicit UnlistedRelaxation(std::span<const double> values)
      : share_(values[0]), time_constant_s_(values[1]) {}

  void reset() override { begun_ = false; }

  double measured_N(double force_N, const SoilContact& contact) override {
    if (!begun_) relaxed_N_ = 0;
    const double dt_s = begun_ ? contact.time_s - time_s_ : 0.0;
    // Exact for a force that stays over the step.
    relaxed_N_ -= (share_ * force_N - relaxed_N_) * std::expm1(-dt_s / time_constant_s_);
    begun_ = true;
    time_s_ = contact.time_s;
    // Out of the ground nothing is left to relax.
    if (!(contact.depth_m > 0)) relaxed_N_ = 0;
    return force_N - relaxed_N_;
  }

 private:
  double share_, time_constant_s_;
  bool begun_ = false;
  double time_s_ = 0, relaxed_N_ = 0;
};

}  // namespace

EffectInfo unlisted_relaxation_effect() {
  return {.name = "unlisted_relaxation",
          .plug_in = PlugIn::kTerrain,
          .summary = "the force falls while the plate is held: the sand creeps",
          .equation = "force = F - x, time_constant dx/dt = share F - x",
          .source = "a stand-in: a standard linear solid in series with the sand",
          .parameters = {{"share", "1", 0.0, 1, 0.1, true, false, {0.1}},
                         {"time_constant", "s", 0.02, 1e3, 3, true, false, {0.5, 5}}},
          .experiment = "press, hold the height for a minute, press on",
          .listed = false,
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<UnlistedRelaxation>(values);
          }};
}

}  // namespace hoof::sim
