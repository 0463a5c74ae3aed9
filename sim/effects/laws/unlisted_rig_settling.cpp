// Symbols: F push force, N.
//   travel = play (1 - exp(-F / scale))
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnlistedRigSettling final : public SoilEffect {
 public:
  explicit UnlistedRigSettling(std::span<const double> values)
      : play_m_(values[0]), scale_N_(values[1]) {}

  double rig_travel_m(double force_N) const override {
    return -play_m_ * std::expm1(-force_N / scale_N_);
  }

 private:
  double play_m_, scale_N_;
};

}  // namespace

EffectInfo unlisted_rig_settling_effect() {
  return {.name = "unlisted_rig_settling",
          .plug_in = PlugIn::kRig,
          .summary = "a joint of the rig closes before it bears: soft at first, stiff then",
          .equation = "travel = play (1 - exp(-F / scale))",
          .source = "a stand-in: play, gaskets and screws",
          .parameters = {{"play", "m", 0.0, 0.05, 5e-4, true, false, {3e-4}},
                         {"scale", "N", 0.01, 1e5, 20, true, false, {5, 50}}},
          .experiment = "press on a rigid block from the smallest force up, and back",
          .listed = false,
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<UnlistedRigSettling>(values);
          }};
}

}  // namespace hoof::sim
