// Full gap between motor side (encoder) and link: the link is driven at the ends of the gap only.
#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class Backlash final : public JointEffect {
 public:
  explicit Backlash(std::span<const double> values) : gap_rad_(values[0]) {}

  unsigned stages() const override { return kGearStage; }
  double gap_rad() const override { return gap_rad_; }

 private:
  double gap_rad_;
};

}  // namespace

EffectInfo backlash_effect() {
  return {.name = "backlash",
          .plug_in = PlugIn::kJoint,
          .summary = "play in the gear: after a reversal the motor turns alone",
          .equation = "link free within +-gap/2 of the motor side",
          .source =
              "Nordin, Gutman, Controlling mechanical systems with backlash - a survey, "
              "Automatica 38 (2002) 1633",
          .parameters = {{"gap", "rad", 0, 1, 0.03, true, false, {0.01, 0.03, 0.1}}},
          .experiment =
              "slow reversals about the hanging position, where the load changes side, "
              "and a tap test with the motor held",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<Backlash>(values);
          }};
}

}  // namespace hoof::sim
