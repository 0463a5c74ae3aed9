// Symbols: T dimensionless warmth, i current, i_rms its rms over the data.
//   time_constant dT/dt = (i / i_rms)^2 - T,  T(0) = 0 in each recording
//   torque constant = nominal (1 - fraction T)
// A motor at i_rms for long stands at T = 1, so that fraction is what it loses in the end.
#include <algorithm>
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class ThermalDerating final : public JointEffect {
 public:
  explicit ThermalDerating(std::span<const double> values)
      : fraction_(values[0]), time_constant_s_(values[1]) {}

  unsigned stages() const override { return kMotorStage; }

  void reset(double /*current_rms_A*/, double torque_rms_Nm) override {
    warmth_ = 0;
    scale_ = torque_rms_Nm > 0 ? 1 / (torque_rms_Nm * torque_rms_Nm) : 0;
  }

  double motor_torque_Nm(double torque_Nm, double /*w*/, double dt_s) override {
    const double share = dt_s / (time_constant_s_ + 0.5 * dt_s);
    warmth_ += share * (torque_Nm * torque_Nm * scale_ - warmth_);
    return torque_Nm * std::max(0.0, 1 - fraction_ * warmth_);
  }

 private:
  double fraction_, time_constant_s_;
  double warmth_ = 0, scale_ = 0;
};

}  // namespace

EffectInfo thermal_derating_effect() {
  return {.name = "thermal_derating",
          .plug_in = PlugIn::kDrive,
          .summary = "a motor that weakens as it warms up",
          .equation =
              "torque constant falls by fraction * T; T follows (current / its rms)^2 with "
              "time_constant",
          .source =
              "loss of remanence and rise of resistance with temperature: Hanselman, Brushless "
              "Permanent Magnet Motor Design, 2nd ed., ch. 10",
          .parameters = {{"fraction", "1", 0, 0.95, 0.1, true, false, {0.15}},
                         {"time_constant", "s", 0.05, 300, 5, true, false, {0.1, 0.25, 0.7, 2.5, 10}}},
          .experiment = "the same load cycle three times without a pause, on a measured supply",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<ThermalDerating>(values);
          }};
}

}  // namespace hoof::sim
