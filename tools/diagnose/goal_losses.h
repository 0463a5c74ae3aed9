// Goals that never reached a drive, told from the torque it commanded.
#pragma once

#include <span>
#include <vector>

namespace hoof::tools {

/// What a drive commands at sample i for the goals of sample k: base[i] + goal[k], clipped.
struct GoalEvidence {
  std::span<const double> torque_Nm;  // as commanded or made; NaN: missing
  std::vector<double> base_Nm;        // of position and speed
  std::vector<double> goal_Nm;        // of all goals
  double limit_Nm = 0;
  double noise_Nm = 0;
};

struct GoalLosses {
  std::vector<bool> lost;  // at each sample; empty: none is
  int bursts = 0;
  double lost_share = 0;
  double stays_lost = 0;  // probability that the sample after a lost one is lost
  double gain = 0;        // half the fall of the sum of squares, bursts paid for
};

/// The most likely sequence of ages of the goal in force (Viterbi, IEEE Trans. Inf. Theory 13
/// (1967) 260): an age grows by one while goals are lost and falls to zero when one arrives.
GoalLosses find_losses(const GoalEvidence& evidence);

}  // namespace hoof::tools
