// Symbols: q output angle, rad.
//   torque = amplitude sin(order q + phase)
#include <cmath>
#include <numbers>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class CoggingTorque final : public JointEffect {
 public:
  explicit CoggingTorque(std::span<const double> values)
      : amplitude_Nm_(values[0]), order_(values[1]), phase_rad_(values[2]) {}

  unsigned stages() const override { return kLinkStage; }

  double link_torque_Nm(double q_rad, double /*w_rad_s*/, double /*time_s*/) override {
    return amplitude_Nm_ * std::sin(order_ * q_rad + phase_rad_);
  }

 private:
  double amplitude_Nm_, order_, phase_rad_;
};

}  // namespace

EffectInfo cogging_torque_effect() {
  return {
      .name = "cogging_torque",
      .plug_in = PlugIn::kJoint,
      .summary = "a torque that repeats with the output's angle: magnets or teeth",
      .equation = "torque = amplitude * sin(order * q + phase)",
      .source = "Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed., ch. 9",
      .parameters = {{"amplitude", "Nm", 0.0, 1e3, 0.05, true, false, {0.03}},
                     {"order", "1/rev", 1, 120, 20, false, false, {1,  2,  3,  4,  5,  6,  7,  8,
                                                                   9,  10, 11, 12, 13, 14, 15, 16,
                                                                   17, 18, 19, 20, 21, 22, 23, 24,
                                                                   25, 26, 27, 28, 29, 30, 31, 32,
                                                                   33, 34, 35, 36, 37, 38, 39, 40,
                                                                   42, 44, 46, 48, 50, 52, 54, 56,
                                                                   58, 60, 62, 64, 66, 68, 70, 72}},
                     {"phase",
                      "rad",
                      -std::numbers::pi,
                      std::numbers::pi,
                      2,
                      false,
                      true,
                      {0, 0.5 * std::numbers::pi}}},
      .experiment = "turn slowly through a whole turn at constant speed, both ways",
      .make_joint = [](std::span<const double> values) {
        return std::make_unique<CoggingTorque>(values);
      }};
}

}  // namespace hoof::sim
