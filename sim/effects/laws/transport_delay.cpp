// The goal reaches the drive late.
#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class TransportDelay final : public JointEffect {
 public:
  explicit TransportDelay(std::span<const double> values) : delay_s_(values[0]) {}

  unsigned stages() const override { return kGoalStage; }
  double goal_delay_s() const override { return delay_s_; }

 private:
  double delay_s_;
};

}  // namespace

EffectInfo transport_delay_effect() {
  return {.name = "transport_delay",
          .plug_in = PlugIn::kBus,
          .summary = "goals that reach the drive late",
          .equation = "goal at the drive (t) = goal(t - delay)",
          .source = "Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., ch. 3",
          .parameters = {{"delay", "s", 0, 0.5, 0.02, true, false, {0.005, 0.02, 0.05}}},
          .experiment = "steps and chirps of the goal, recorded with the drive's own time stamps",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<TransportDelay>(values);
          }};
}

}  // namespace hoof::sim
