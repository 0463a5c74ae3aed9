#pragma once

#include <string>
#include <vector>

#include "tools/conceal/servo_plan.h"

namespace hoof::tools::conceal {

/// What the machine does with nothing hidden, over all recordings: the measure of effect sizes.
struct ServoScale {
  double torque_rms = 0, torque_mean_size = 0;
  std::vector<double> torque_sizes;  ///< sorted
  double position_rms = 0, velocity_rms = 0, fastest = 0, highest = 0;
  double current_rms = 0;
};

ServoScale scale_of(const ServoPlan& plan, const std::vector<ServoSignals>& clean);

/// The effects of the contract's section 4 that a servo pendulum can hide.
const std::vector<std::string>& listed_servo_effects();
/// Effects of the examiner's own, in nobody's list.
const std::vector<std::string>& unlisted_servo_effects();

/// What a machine must be like for an effect to be seen in it.
PlanWish wish_for(const std::vector<std::string>& effects, bool stiff, RandomStream& random);

/// An effect whose torque is about `share` of the rms effort (0.03 to 0.5).
HiddenEffect draw_servo_effect(const std::string& name, double share, const ServoPlan& plan,
                               const ServoScale& scale, RandomStream& random);

}  // namespace hoof::tools::conceal
