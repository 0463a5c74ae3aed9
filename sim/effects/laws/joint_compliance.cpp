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

// Load and spring resonate: a start has to be near the truth, so there are many.
EffectInfo joint_compliance_effect() {
  return {.name = "joint_compliance",
          .plug_in = PlugIn::kJoint,
          .summary = "a soft gear or link: the load swings against the motor",
          .equation = "torque on the link = stiffness * (q_motor - q_link)",
          .source = "Spong, Modeling and Control of Elastic Joint Robots, J. Dyn. Sys. 109 (1987)",
          .parameters = {{"stiffness",
                          "Nm/rad",
                          0.1,
                          1e5,
                          20,
                          true,
                          false,
                          {1,    1.2,  1.44, 1.73, 2.07, 2.49, 2.99, 3.58, 4.3,     5.16,
                           6.19, 7.43, 8.92, 10.7, 12.8, 15.4, 18.5, 22.2, 26.6,    31.9,
                           38.3, 46,   55.2, 66.2, 79.5, 95.4, 114,  137,  165,     198,
                           237,  285,  342,  410,  492,  591,  709,  851,  1.02e+03}}},
          .experiment = "a chirp through the resonance of load and spring, 2 to 40 Hz, and steps",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<JointCompliance>(values);
          }};
}

}  // namespace hoof::sim
