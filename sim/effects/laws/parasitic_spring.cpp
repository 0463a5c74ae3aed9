// Symbols: q output angle, rad.
//   torque on the link = -stiffness (q - rest)
#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class ParasiticSpring final : public JointEffect {
 public:
  explicit ParasiticSpring(std::span<const double> values)
      : stiffness_Nm_rad_(values[0]), rest_rad_(values[1]) {}

  unsigned stages() const override { return kLinkStage; }

  double link_torque_Nm(double q_rad, double /*w_rad_s*/, double /*time_s*/) override {
    return -stiffness_Nm_rad_ * (q_rad - rest_rad_);
  }

 private:
  double stiffness_Nm_rad_, rest_rad_;
};

}  // namespace

EffectInfo parasitic_spring_effect() {
  return {.name = "parasitic_spring",
          .plug_in = PlugIn::kJoint,
          .summary = "a spring nobody asked for: a cable, a hose, a seal",
          .equation = "torque = -stiffness * (q - rest)",
          .source = "Hooke's law; cables on robot joints, e.g. Armstrong 1991, ch. 2",
          .parameters = {{"stiffness", "Nm/rad", 0, 1e3, 0.1, true, false, {0.1}},
                         {"rest", "rad", -3.2, 3.2, 0.5, false, false, {-0.8, 0, 0.8}}},
          .experiment = "hold a row of angles over the whole range, with and without the cable",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<ParasiticSpring>(values);
          }};
}

}  // namespace hoof::sim
