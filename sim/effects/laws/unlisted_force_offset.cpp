// Symbols: t time since the recording began, s.
//   measured force = F + offset + drift t

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnlistedForceOffset final : public SoilEffect {
 public:
  explicit UnlistedForceOffset(std::span<const double> values)
      : offset_N_(values[0]), drift_N_s_(values[1]) {}

  double measured_N(double force_N, const SoilContact& contact) override {
    return force_N + offset_N_ + drift_N_s_ * contact.time_s;
  }

 private:
  double offset_N_, drift_N_s_;
};

}  // namespace

EffectInfo unlisted_force_offset_effect() {
  return {.name = "unlisted_force_offset",
          .plug_in = PlugIn::kSensor,
          .summary = "the force sensor has a zero of its own, which creeps",
          .equation = "measured force = F + offset + drift t",
          .source = "a stand-in: load cells creep with temperature",
          .parameters = {{"offset", "N", -1e3, 1e3, 2, false, false, {0}},
                         {"drift", "N/s", -100, 100, 0.1, false, false, {0}}},
          .experiment = "record the force with nothing on the plate before and after each press",
          .listed = false,
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<UnlistedForceOffset>(values);
          }};
}

}  // namespace hoof::sim
