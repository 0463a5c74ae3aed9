// Goals that never reached a drive, told from how the joint went on without them.
#pragma once

#include <span>
#include <vector>

#include "sim/rigs/servo_pendulum.h"

namespace hoof::tools {

/// A recorded channel that closed loop simulation predicts.
struct LossChannel {
  enum Kind { kPosition, kVelocity, kTorque } kind = kPosition;  // rad, rad/s, Nm
  std::span<const double> values;                                // NaN: missing
  double noise = 0;
};

/// A setting that is not known exactly.
struct LossDoubt {
  double sim::PendulumSettings::*setting = nullptr;
  double sigma = 0;  // its unit; of a normal distribution about what is stated, none below zero
};

struct GoalLosses {
  std::vector<sim::LostGoals> lost;  // one per burst, in their order
  double gain = 0;                   // half the fall of the sum of squares, bursts paid for
  double without = 0;                // half the sum of squares as if all goals had arrived

  double lost_s() const;
};

/// The most likely spans in which the last goal was held, of a joint under its position loop. The
/// loop is simulated along with each span that may have begun (Viterbi, IEEE Trans. Inf. Theory 13
/// (1967) 260, with the joint's state carried along); where goals arrive again, the likeliest goes
/// on. Doubtful settings are fitted along each answer; what is left then is taken as noise of that
/// size, and of that memory from sample to sample. No effect acts. Laws kDuty and kImpedance; of
/// fewer than 20 samples nothing is told.
GoalLosses find_losses(const sim::PendulumSettings& settings, const sim::PendulumInputs& inputs,
                       const sim::PendulumStart& start, std::span<const LossChannel> channels,
                       std::span<const LossDoubt> doubts, double longest_step_s);

}  // namespace hoof::tools
