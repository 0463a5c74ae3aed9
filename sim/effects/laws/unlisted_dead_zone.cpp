// A stand-in for physics that the list does not hold.
//   motor torque = torque less `width`, towards zero
#include <algorithm>
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class DeadZone final : public JointEffect {
 public:
  explicit DeadZone(std::span<const double> values) : width_Nm_(values[0]) {}

  unsigned stages() const override { return kMotorStage; }

  double motor_torque_Nm(double torque, double /*w*/, double /*dt_s*/) override {
    return std::copysign(std::max(0.0, std::abs(torque) - width_Nm_), torque);
  }

 private:
  double width_Nm_;
};

}  // namespace

EffectInfo unlisted_dead_zone_effect() {
  return {.name = "unlisted_dead_zone",
          .plug_in = PlugIn::kDrive,
          .summary = "small commands that make no torque",
          .equation = "motor torque = torque less `width`, towards zero",
          .source = "dead time of a bridge",
          .parameters = {{"width", "Nm", 0, 1e3, 0.03, true, false, {0.03}}},
          .experiment = "a slow ramp of torque from rest, both ways",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<DeadZone>(values);
          }};
}

}  // namespace hoof::sim
