// How a recorded goal ran between its samples.
#pragma once

#include <span>
#include <vector>

#include "sim/rigs/servo_pendulum.h"
#include "tools/diagnose/data_set.h"

namespace hoof::tools {

/// One for each sample: of the path between it and the next.
using Bends = std::vector<sim::SlopeOffset>;

/// Empty where the channel was not recorded.
struct GoalBends {
  Bends position;  // rad/s, of position_goal
  Bends velocity;  // rad/s^2, of velocity_goal
  Bends torque;    // Nm/s, of torque_ff
};

/// Of the curvature at both ends of a span, each by the parabola through three samples, where they
/// agree within a factor of three: their mean. Else the smaller, or none where they differ in sign:
/// a corner of a path stays a corner, and a step a step (as essentially non-oscillatory schemes do;
/// Harten et al., J. Comput. Phys. 71 (1987) 231).
/// @param time_s rising, as long as values
Bends bends(std::span<const double> time_s, std::span<const double> values);

/// Of a position goal the recorded velocity goals are the slopes, wherever the line between two
/// samples is steeper than one of them and flatter than the other.
GoalBends goal_bends(const Recording& recording);

}  // namespace hoof::tools
