// Presses made by the model itself, as data sets in memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/diagnose/press_model.h"

namespace hoof::tests {

/// A carriage that goes down to `deepest_m` below a surface at `surface_m` and back up.
struct PressPlan {
  std::string name;
  double diameter_m = 0.08;
  double deepest_m = 0.03;
  double speed_m_s = 0.003;
  double back_m = 0;  // how far it is drawn back
  bool holdout = false;
  int cycles = 1;  // drawn out of the sand between them
};

tools::DataSet sand_set(const std::vector<PressPlan>& plans);

/// A block pressed to `largest_N` and let go.
tools::DataSet block_set(double largest_N);

/// Replaces what the model predicts by its own prediction with noise.
/// @param setup in the order of PressModel::doubtful
void simulate_into(std::vector<tools::DataSet>& sets, const std::vector<double>& setup,
                   const std::vector<tools::ActiveEffect>& effects, double force_noise_N,
                   double position_noise_m, std::uint64_t seed);

tools::ActiveEffect active(const std::string& name, const std::vector<double>& values);

}  // namespace hoof::tests
