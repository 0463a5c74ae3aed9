// A stand-in for physics that the list does not hold.
//   torque = amplitude sin(rate t + phase)
#include <cmath>
#include <numbers>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class Disturbance final : public JointEffect {
 public:
  explicit Disturbance(std::span<const double> values)
      : a_Nm_(values[0]), rate_(values[1]), phase_(values[2]) {}

  unsigned stages() const override { return kLinkStage; }

  double link_torque_Nm(double /*q*/, double /*w*/, double t) override {
    return a_Nm_ * std::sin(rate_ * t + phase_);
  }

 private:
  double a_Nm_, rate_, phase_;
};

}  // namespace

EffectInfo unlisted_disturbance_effect() {
  return {
      .name = "unlisted_disturbance",
      .plug_in = PlugIn::kJoint,
      .summary = "a torque that repeats in time, not in angle",
      .equation = "torque = amplitude sin(rate t + phase)",
      .source = "unbalanced machinery nearby",
      .parameters =
          {{"amplitude", "Nm", 0, 1e3, 0.05, true, false, {0.05}},
           {"rate", "rad/s", 0.2, 200, 10, false, false, {1, 2, 3, 4.5, 6.3, 9, 12.6, 18, 25, 38}},
           {"phase",
            "rad",
            -std::numbers::pi,
            std::numbers::pi,
            2,
            false,
            true,
            {0, 1.571, 3.14, -1.571}}},
      .experiment = "hold still and record for a minute",
      .listed = false,
      .make_joint = [](std::span<const double> values) {
        return std::make_unique<Disturbance>(values);
      }};
}

}  // namespace hoof::sim
