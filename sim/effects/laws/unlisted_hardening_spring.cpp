// A stand-in for physics that the list does not hold.
//   torque = -coefficient q^3

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class HardeningSpring final : public JointEffect {
 public:
  explicit HardeningSpring(std::span<const double> values) : k_(values[0]) {}

  unsigned stages() const override { return kLinkStage; }

  double link_torque_Nm(double q, double /*w*/, double /*t*/) override { return -k_ * q * q * q; }

 private:
  double k_;
};

}  // namespace

EffectInfo unlisted_hardening_spring_effect() {
  return {.name = "unlisted_hardening_spring",
          .plug_in = PlugIn::kJoint,
          .summary = "a spring that is not linear",
          .equation = "torque = -coefficient q^3",
          .source = "Duffing",
          .parameters = {{"coefficient", "Nm/rad3", -1e3, 1e3, 0.05, false, false, {0.05}}},
          .experiment = "hold a row of angles over the whole range",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<HardeningSpring>(values);
          }};
}

}  // namespace hoof::sim
