// Symbols: w output speed, rad/s.
//   F = coulomb (1 + asymmetry) for w >= 0, coulomb (1 - asymmetry) for w < 0, no less than zero
// At rest the direction is the one in which the torque pushes: the plant asks with the sign of the
// motion that would begin.
#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class DirectionalFriction final : public JointEffect {
 public:
  explicit DirectionalFriction(std::span<const double> values) : asymmetry_(values[0]) {}

  unsigned stages() const override { return kFrictionStage; }

  double friction_Nm(const JointMotion& motion) const override {
    const bool back = motion.velocity_rad_s < 0;
    return back ? -asymmetry_ * motion.coulomb_Nm : asymmetry_ * motion.coulomb_Nm;
  }

 private:
  double asymmetry_;
};

}  // namespace

EffectInfo directional_friction_effect() {
  return {.name = "directional_friction",
          .plug_in = PlugIn::kJoint,
          .summary = "friction that differs between the two directions",
          .equation =
              "friction = coulomb * (1 + asymmetry) for w >= 0, * (1 - asymmetry) for w < 0, "
              "no less than zero",
          .source = "Armstrong, Control of Machines with Friction, 1991, ch. 4",
          .parameters = {{"asymmetry", "1", -3, 3, 0.3, false, false, {0.3}}},
          .experiment = "the same slow triangle both ways through the same angles",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<DirectionalFriction>(values);
          }};
}

}  // namespace hoof::sim
