// A stand-in for physics that the list does not hold.
//   torque = constant

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class TorqueBias final : public JointEffect {
 public:
  explicit TorqueBias(std::span<const double> values) : bias_Nm_(values[0]) {}

  unsigned stages() const override { return kLinkStage; }

  double link_torque_Nm(double /*q*/, double /*w*/, double /*t*/) override { return bias_Nm_; }

 private:
  double bias_Nm_;
};

}  // namespace

EffectInfo unlisted_torque_bias_effect() {
  return {.name = "unlisted_torque_bias",
          .plug_in = PlugIn::kJoint,
          .summary = "a constant torque",
          .equation = "torque = constant",
          .source = "offset of a torque sensor or current zero",
          .parameters = {{"bias", "Nm", -1e3, 1e3, 0.05, false, false, {0.05}}},
          .experiment = "the same motion mirrored, and the zero of the torque with the motor off",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<TorqueBias>(values);
          }};
}

}  // namespace hoof::sim
