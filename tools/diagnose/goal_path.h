// Trajectories of a goal, put together from simple pieces.
#pragma once

#include <vector>

namespace hoof::tools {

/// Samples of a goal angle and of whether the drive is on, a step apart.
class GoalPath {
 public:
  GoalPath(double start_rad, double step_s) : step_s_(step_s), goal_rad_{start_rad}, on_{1} {}

  GoalPath& hold(double time_s);
  /// At constant speed.
  GoalPath& ramp(double to_rad, double speed_rad_s);
  /// Along half a cosine whose steepest slope is `speed_rad_s`.
  GoalPath& ease(double to_rad, double speed_rad_s);
  GoalPath& jump(double to_rad);
  /// About the goal as it stands, for whole cycles.
  GoalPath& sine(double amplitude_rad, double frequency_Hz, int cycles);
  /// The frequency grows exponentially; the amplitude is no more than the speed allows.
  GoalPath& chirp(double amplitude_rad, double from_Hz, double to_Hz, double time_s,
                  double speed_rad_s);
  GoalPath& off(double time_s);

  std::vector<double> time_s() const;
  const std::vector<double>& goal_rad() const { return goal_rad_; }
  /// Empty where the drive is on all along.
  std::vector<double> enable() const;
  double last_rad() const { return goal_rad_.back(); }

 private:
  int samples(double time_s) const;
  void add(double goal_rad, bool on = true);

  double step_s_;
  std::vector<double> goal_rad_, on_;
};

}  // namespace hoof::tools
