// Symbols: tau_m motor torque, tau_ext what gravity and springs put on the link, both at the
// output.
//   F = coulomb + coefficient |tau_m - tau_ext|
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class LoadDependentFriction final : public JointEffect {
 public:
  explicit LoadDependentFriction(std::span<const double> values) : coefficient_(values[0]) {}

  unsigned stages() const override { return kFrictionStage; }

  double friction_Nm(const JointMotion& motion) const override {
    return coefficient_ * std::abs(motion.motor_torque_Nm - motion.external_torque_Nm);
  }

 private:
  double coefficient_;
};

}  // namespace

EffectInfo load_dependent_friction_effect() {
  return {.name = "load_dependent_friction",
          .plug_in = PlugIn::kJoint,
          .summary = "gear friction that grows with the torque the gear carries",
          .equation = "friction = coulomb + coefficient * |tau_m - tau_ext|",
          .source =
              "Duclusaud, Passault, Padois, Ly, Extended Friction Models for the Physics "
              "Simulation of Servo Actuators, ICRA 2025 (model M3)",
          .parameters = {{"coefficient", "1", 0, 0.95, 0.1, true, false, {0.1}}},
          .experiment = "the same slow motion with two payloads, and held at several angles",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<LoadDependentFriction>(values);
          }};
}

}  // namespace hoof::sim
