// A stand-in for physics that the list does not hold.
//   torque = amplitude cos(q)
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class Tilt final : public JointEffect {
 public:
  explicit Tilt(std::span<const double> values) : a_Nm_(values[0]) {}

  unsigned stages() const override { return kLinkStage; }

  double link_torque_Nm(double q, double /*w*/, double /*t*/) override {
    return a_Nm_ * std::cos(q);
  }

 private:
  double a_Nm_;
};

}  // namespace

EffectInfo unlisted_tilt_effect() {
  return {
      .name = "unlisted_tilt",
      .plug_in = PlugIn::kJoint,
      .summary = "a base that is not upright, or a mass beside the arm",
      .equation = "torque = amplitude cos(q)",
      .source = "gravity in a tilted frame",
      .parameters = {{"amplitude", "Nm", -1e3, 1e3, 0.05, false, false, {0.05}}},
      .experiment = "let it hang free and read the angle",
      .listed = false,
      .make_joint = [](std::span<const double> values) { return std::make_unique<Tilt>(values); }};
}

}  // namespace hoof::sim
