// A recording of a press, made ready for the model: gaps filled, speed found, presses counted.
#pragma once

#include <span>
#include <vector>

#include "sim/rigs/plate_press.h"
#include "tools/diagnose/data_set.h"

namespace hoof::tools {

/// Height and speed of the carriage from a measured height. Height: a least-squares parabola over
/// the sample and three on each side (Savitzky, Golay: Anal. Chem. 36 (1964) 1627, here for any
/// times), where it is within the noise of what was measured; elsewhere as measured. Speed,
/// downward: a line over as few neighbours as the noise allows, at most 0.1 s on each side. Missing
/// samples are bridged.
/// @return with no presses counted
sim::PressPath press_path(std::span<const double> time_s, std::span<const double> height_m);

/// Fills path.press: `before`, and one more each time the plate has left the sand.
/// @return presses that have gone before the next recording
int count_presses(sim::PressPath& path, double surface_height_m, int before);

/// Samples of a press on a rigid block in which the plate bears on it.
std::vector<bool> on_block(std::span<const double> time_s, std::span<const double> height_m,
                           std::span<const double> force_N);

}  // namespace hoof::tools
