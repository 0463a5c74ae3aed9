// A stand-in for physics that the list does not hold.
//   motor torque = torque / (1 + |torque| / scale)
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class Saturation final : public JointEffect {
 public:
  explicit Saturation(std::span<const double> values) : scale_Nm_(values[0]) {}

  unsigned stages() const override { return kMotorStage; }

  double motor_torque_Nm(double torque, double /*w*/, double /*dt_s*/) override {
    return torque / (1 + std::abs(torque) / scale_Nm_);
  }

 private:
  double scale_Nm_;
};

}  // namespace

EffectInfo unlisted_saturation_effect() {
  return {.name = "unlisted_saturation",
          .plug_in = PlugIn::kDrive,
          .summary = "a motor whose torque grows less than its current",
          .equation = "motor torque = torque / (1 + |torque| / scale)",
          .source = "saturation of iron",
          .parameters = {{"scale", "Nm", 1e-3, 1e5, 5, true, false, {2}}},
          .experiment = "hold growing loads and read the current",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<Saturation>(values);
          }};
}

}  // namespace hoof::sim
