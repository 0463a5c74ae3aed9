// How a recorded goal ran between its samples.
#pragma once

#include <span>
#include <vector>

#include "tools/diagnose/data_set.h"

namespace hoof::tools {

/// Slopes at the samples for a cubic between them; empty where the channel was not recorded.
struct GoalSlopes {
  std::vector<double> position;  // rad/s, of position_goal
  std::vector<double> velocity;  // rad/s^2, of velocity_goal
  std::vector<double> torque;    // Nm/s, of torque_ff
};

/// Of the parabola through three samples, no steeper than three times the flatter side: a path that
/// rises or falls stays between its samples (Fritsch, Carlson 1980), and a step of a goal a step.
/// @param time_s rising, as long as values
std::vector<double> limited_slopes(std::span<const double> time_s, std::span<const double> values);

/// Of a position goal the recorded velocity goal is the slope, wherever the cubic stays monotone
/// with it; so a goal that jumps beside a velocity goal of zero stays a jump.
GoalSlopes goal_slopes(const Recording& recording);

}  // namespace hoof::tools
