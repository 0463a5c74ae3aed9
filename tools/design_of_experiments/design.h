// Which runs to make: designs for a quadratic response surface.
#pragma once

#include <vector>

namespace hoof::tools {

/// One row for each run, one coded value (-1 low, 0 middle, 1 high) for each factor.
using Design = std::vector<std::vector<double>>;

/// Box, Behnken: Technometrics 2 (1960) 455: each pair of factors at its four corners, the others
/// in the middle. @param factors 3..5  @param centres runs in the middle of all, last
Design box_behnken(int factors, int centres);

/// Box, Wilson 1951: corners, two runs on each axis, centres. @param factors 2..6
/// @param axis coded distance of the axial runs: 1 stays within the bounds (face-centred)
Design central_composite(int factors, int centres, double axis);

/// The axis at which the variance of a prediction depends on the distance from the middle only:
/// the fourth root of the number of corners.
double rotatable_axis(int factors);

/// A random order of the runs. Same seed, same order, on any machine.
std::vector<int> run_order(int runs, unsigned long long seed);

}  // namespace hoof::tools
