// Symbols: w output speed, rad/s.
//   F(w) = coulomb + extra exp(-(w / speed)^2), at rest too
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class StribeckFriction final : public JointEffect {
 public:
  explicit StribeckFriction(std::span<const double> values)
      : extra_Nm_(values[0]), speed_rad_s_(values[1]) {}

  unsigned stages() const override { return kFrictionStage; }

  double friction_Nm(const JointMotion& motion) const override {
    const double x = motion.velocity_rad_s / speed_rad_s_;
    return extra_Nm_ * std::exp(-x * x);
  }

 private:
  double extra_Nm_, speed_rad_s_;
};

}  // namespace

EffectInfo stribeck_friction_effect() {
  return {.name = "stribeck_friction",
          .plug_in = PlugIn::kJoint,
          .summary = "friction that is higher near standstill and falls with speed",
          .equation = "friction = coulomb + extra * exp(-(w / speed)^2)",
          .source = "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083",
          .parameters = {{"extra", "Nm", 0, 1e3, 0.05, true, false, {0.3}},
                         {"speed", "rad/s", 1e-3, 20, 0.3, true, false, {0.05, 0.2, 0.8, 2.5}}},
          .experiment =
              "slow triangles both ways at four speeds from 0.02 to 2 rad/s, and starts "
              "from rest under a slowly growing torque",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<StribeckFriction>(values);
          }};
}

}  // namespace hoof::sim
