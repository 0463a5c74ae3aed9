// What the operator has the joint do.

#include <cmath>

#include "tools/conceal/servo_plan.h"

namespace hoof::tools::conceal {
namespace {

/// There and back between two angles at constant speed.
GoalPath slow_triangle(double duration_s, RandomStream& random) {
  GoalPath path;
  const double reach = random.uniform(0.7, 1.5);
  const double leg_s = random.uniform(1.4, 2.4);
  double t_s = 0.3, at = 0.0, side = random.sign();
  while (t_s < duration_s) {
    const double to = side * reach * random.uniform(0.8, 1.0);
    path.moves.push_back({t_s, leg_s, to - at, false});
    at = to;
    side = -side;
    t_s += leg_s + random.uniform(0.0, 0.3);
  }
  return path;
}

GoalPath several_sines(RandomStream& random) {
  GoalPath path;
  path.fade_in_s = 0.8;
  path.offset = random.uniform(-0.3, 0.3);
  const int count = random.integer(2, 4);
  for (int i = 0; i < count; ++i) {
    const double frequency_Hz = random.log_uniform(0.2, 2.2);
    const double amplitude = random.uniform(0.3, 0.8) / (0.6 + frequency_Hz) / std::sqrt(count);
    path.sines.push_back({1.6 * amplitude, frequency_Hz, random.uniform(0.0, 6.28)});
  }
  return path;
}

GoalPath one_sine(RandomStream& random) {
  GoalPath path;
  path.fade_in_s = 0.6;
  path.offset = random.uniform(-0.5, 0.5);
  path.sines.push_back({random.uniform(0.4, 1.0), random.log_uniform(0.2, 0.9), 0.0});
  return path;
}

GoalPath chirp(double duration_s, RandomStream& random) {
  GoalPath path;
  path.fade_in_s = 0.5;
  path.offset = random.uniform(-0.4, 0.4);
  path.chirps.push_back(
      {random.uniform(0.4, 0.9), random.uniform(0.1, 0.25), random.uniform(1.5, 3.0), duration_s});
  return path;
}

GoalPath steps_and_holds(double duration_s, RandomStream& random) {
  GoalPath path;
  double t_s = random.uniform(0.3, 0.8), at = 0.0;
  while (t_s < duration_s - 0.3) {
    double to = random.uniform(-1.4, 1.4);
    if (std::abs(to - at) < 0.3) to = at > 0.0 ? at - 0.8 : at + 0.8;
    const double ramp_s = random.uniform(0.08, 0.3);
    path.moves.push_back({t_s, ramp_s, to - at, true});
    at = to;
    t_s += ramp_s + random.uniform(0.5, 1.4);
  }
  return path;
}

GoalPath lift_and_drop(double duration_s, RandomStream& random, double& disable_at_s) {
  GoalPath path;
  const double lift_s = random.uniform(1.5, 2.5);
  path.moves.push_back({0.3, lift_s, random.sign() * random.uniform(0.9, 1.7), true});
  // On a whole number of any control period.
  disable_at_s = 0.02 * std::round((lift_s + random.uniform(0.8, 0.3 * duration_s)) / 0.02);
  return path;
}

GoalPath sine_of_growing_rate(RandomStream& random) {
  GoalPath path;
  path.fade_in_s = 0.4;
  path.chirps.push_back({random.uniform(0.8, 1.4), random.uniform(0.08, 0.15), 1.2, 9.0});
  return path;
}

}  // namespace

GoalPath draw_position_path(int kind, double duration_s, RandomStream& random,
                            double& disable_at_s) {
  switch (kind % 7) {
    case 0:
      return slow_triangle(duration_s, random);
    case 1:
      return several_sines(random);
    case 2:
      return steps_and_holds(duration_s, random);
    case 3:
      return lift_and_drop(duration_s, random, disable_at_s);
    case 4:
      return chirp(duration_s, random);
    case 5:
      return one_sine(random);
    default:
      return sine_of_growing_rate(random);
  }
}

}  // namespace hoof::tools::conceal
