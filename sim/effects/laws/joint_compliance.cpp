// A spring between motor side (encoder) and link.
//   torque on the link = stiffness (q_motor - q_link)
#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class JointCompliance final : public JointEffect {
 public:
  explicit JointCompliance(std::span<const double> values) : stiffness_Nm_rad_(values[0]) {}

  unsigned stages() const override { return kGearStage; }
  double stiffness_Nm_rad() const override { return stiffness_Nm_rad_; }

 private:
  double stiffness_Nm_rad_;
};

}  // namespace

EffectInfo joint_compliance_effect() {
  return {.name = "joint_compliance",
          .plug_in = PlugIn::kJoint,
          .summary = "a soft gear or link: the load swings against the motor",
          .equation = "torque on the link = stiffness * (q_motor - q_link)",
          .source = "Spong, Modeling and Control of Elastic Joint Robots, J. Dyn. Sys. 109 (1987)",
          .parameters = {{"stiffness", "Nm/rad", 0.1, 1e5, 20, true, false, {2, 6, 20, 60}}},
          .experiment = "a chirp through the resonance of load and spring, 2 to 40 Hz, and steps",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<JointCompliance>(values);
          }};
}

}  // namespace hoof::sim
