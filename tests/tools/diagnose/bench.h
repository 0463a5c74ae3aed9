// Recordings of rigs with nothing wrong with them, made by formula and a plain integrator.
#pragma once

#include <cstdint>
#include <filesystem>

#include "tools/diagnose/data_set.h"

namespace hoof::tests {

struct PendulumBench {
  std::uint64_t seed = 1;
  double kp = 8, kd = 0.4;  // Nm/rad, Nm s/rad
  double length_s = 8, step_s = 0.005;
  double position_noise = 0.001, velocity_noise = 0.02, torque_noise = 0.02;  // SI
  double speed_factor = 1;                                                    // of the goals
  double encoder_step_rad = 0;  // 0: as fine as numbers are
  /// Of the last third's steps: 0 at once. When between two samples a jump came no recording tells.
  double move_s = 0;
};

/// A link under the law "impedance" that follows sines, ramps and steps, with dry and viscous
/// friction; channels position_goal, position, velocity, torque. Recording "run.csv", to fit.
tools::DataSet pendulum_bench(const PendulumBench& bench);

/// Writes recordings as CSV and the data set as `folder`/bench.toml.
std::filesystem::path write_bench(const tools::DataSet& set, const std::filesystem::path& folder);

/// A plate of 50 mm by 100 mm pressed 30 mm into Bekker's soil and out again. "press.csv".
tools::DataSet sand_bench(std::uint64_t seed);

}  // namespace hoof::tests
