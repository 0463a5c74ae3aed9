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
           {"rate", "rad/s", 0.2, 200, 10, false, false, {0.4,  0.8,  1.2, 1.6,  2,    2.5,  3,
                                                          3.5,  4,    4.5, 5,    5.6,  6.3,  7,
                                                          7.8,  8.6,  9.4, 10.2, 11,   12,   12.6,
                                                          13.4, 14.2, 15,  15.8, 16.6, 17.4, 18.2,
                                                          19,   20,   21,  22,   23,   24,   25.1,
                                                          26,   27,   28,  29,   30,   31.4}},
           {"phase",
            "rad",
            -std::numbers::pi,
            std::numbers::pi,
            2,
            false,
            true,
            {0, 0.5 * std::numbers::pi}}},
      .experiment = "hold still and record for a minute",
      .listed = false,
      .make_joint = [](std::span<const double> values) {
        return std::make_unique<Disturbance>(values);
      }};
}

}  // namespace hoof::sim
