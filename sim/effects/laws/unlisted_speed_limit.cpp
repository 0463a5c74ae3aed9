// A stand-in for physics that the list does not hold.
//   motor torque falls by |w| / speed while it drives
#include <algorithm>
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class SpeedLimit final : public JointEffect {
 public:
  explicit SpeedLimit(std::span<const double> values) : speed_(values[0]) {}

  unsigned stages() const override { return kMotorStage; }

  double motor_torque_Nm(double torque, double w, double /*dt_s*/) override {
    return torque * w > 0 ? torque * std::max(0.0, 1 - std::abs(w) / speed_) : torque;
  }

 private:
  double speed_;  // rad/s
};

}  // namespace

EffectInfo unlisted_speed_limit_effect() {
  return {.name = "unlisted_speed_limit",
          .plug_in = PlugIn::kDrive,
          .summary = "a motor that runs out of voltage at speed",
          .equation = "motor torque falls by |w| / speed while it drives",
          .source = "speed-torque line of a DC motor",
          .parameters = {{"speed", "rad/s", 0.1, 1e4, 30, true, false, {10, 40}}},
          .experiment = "fast sweeps at two supply voltages",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<SpeedLimit>(values);
          }};
}

}  // namespace hoof::sim
