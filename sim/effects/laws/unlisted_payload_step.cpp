// A stand-in for physics that the list does not hold.
//   torque = -amplitude sin(q) from `start` on
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class PayloadStep final : public JointEffect {
 public:
  explicit PayloadStep(std::span<const double> values) : a_Nm_(values[0]), start_s_(values[1]) {}

  unsigned stages() const override { return kLinkStage; }

  double link_torque_Nm(double q, double /*w*/, double t) override {
    return t < start_s_ ? 0 : -a_Nm_ * std::sin(q);
  }

 private:
  double a_Nm_, start_s_;
};

}  // namespace

EffectInfo unlisted_payload_step_effect() {
  return {.name = "unlisted_payload_step",
          .plug_in = PlugIn::kJoint,
          .summary = "a load that changes on the way",
          .equation = "torque = -amplitude sin(q) from `start` on",
          .source = "something fell off, or slid",
          .parameters = {{"amplitude", "Nm", -1e3, 1e3, 0.1, false, false, {0.1}},
                         {"start", "s", 0, 1e3, 3, false, false, {1, 2, 3, 4, 5, 6, 7}}},
          .experiment = "weigh the payload after the run",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<PayloadStep>(values);
          }};
}

}  // namespace hoof::sim
