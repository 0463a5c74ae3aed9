// A stand-in for physics that the list does not hold.
//   friction = coulomb + a sin(q) + b cos(q)
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class PositionFriction final : public JointEffect {
 public:
  explicit PositionFriction(std::span<const double> values) : a_Nm_(values[0]), b_Nm_(values[1]) {}

  unsigned stages() const override { return kFrictionStage; }

  double friction_Nm(const JointMotion& motion) const override {
    return a_Nm_ * std::sin(motion.position_rad) + b_Nm_ * (std::cos(motion.position_rad) - 1);
  }

 private:
  double a_Nm_, b_Nm_;
};

}  // namespace

EffectInfo unlisted_position_friction_effect() {
  return {.name = "unlisted_position_friction",
          .plug_in = PlugIn::kJoint,
          .summary = "friction that depends on the angle",
          .equation = "friction = coulomb + a sin(q) + b cos(q)",
          .source = "Armstrong, Control of Machines with Friction, 1991, ch. 4",
          .parameters = {{"a", "Nm", -1e3, 1e3, 0.05, false, false, {0.02}},
                         {"b", "Nm", -1e3, 1e3, 0.05, false, false, {0.02}}},
          .experiment = "slow triangles over the whole range, both ways",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<PositionFriction>(values);
          }};
}

}  // namespace hoof::sim
