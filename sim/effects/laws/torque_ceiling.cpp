// torque_motor clipped to +-ceiling, whatever was commanded.
#include <algorithm>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class TorqueCeiling final : public JointEffect {
 public:
  explicit TorqueCeiling(std::span<const double> values) : ceiling_Nm_(values[0]) {}

  unsigned stages() const override { return kMotorStage; }

  double motor_torque_Nm(double torque_Nm, double /*w*/, double /*dt_s*/) override {
    return std::clamp(torque_Nm, -ceiling_Nm_, ceiling_Nm_);
  }

 private:
  double ceiling_Nm_;
};

}  // namespace

EffectInfo torque_ceiling_effect() {
  return {.name = "torque_ceiling",
          .plug_in = PlugIn::kDrive,
          .summary =
              "the motor makes no more than a certain torque: a current limit nobody wrote "
              "down",
          .equation = "torque_motor = clip(torque, +-ceiling)",
          .source =
              "current limit of drive electronics, e.g. Dynamixel XL330 e-manual, Current "
              "Limit(38)",
          .parameters = {{"ceiling",
                          "Nm",
                          1e-3,
                          1e3,
                          1,
                          true,
                          false,
                          {0.06, 0.12, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9}}},
          .experiment = "hold growing loads, up to twice the torque seen so far",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<TorqueCeiling>(values);
          }};
}

}  // namespace hoof::sim
