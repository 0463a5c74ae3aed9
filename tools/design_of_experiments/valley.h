// Which factors give one and the same response: the set that a single test cannot tell apart, and
// what a second test leaves of it.
#pragma once

#include <vector>

#include "tools/design_of_experiments/response_surface.h"

namespace hoof::tools {

struct Valley {
  /// Points of a regular grid over the factors' bounds whose response is within the tolerance of
  /// the target, coded.
  std::vector<std::vector<double>> points;
  double share = 0;  // of all points of the grid

  /// Of each factor, the range that the points take, in natural units.
  std::vector<double> low, high;

  /// What knowing one factor to +- its doubt leaves, for each factor: the share of the valley that
  /// stays, in the mean over the valley, and the mean width of each other factor's range then over
  /// its range in the whole valley.
  struct Left {
    double doubt = 0;  // natural units
    double share = 0;
    std::vector<double> width;
  };
  std::vector<Left> left;

  /// Index of the factor whose knowledge leaves least of it; -1: the valley is empty.
  int most_telling() const;
};

/// @param tolerance of the response, in its unit
/// @param doubts of each factor in a second test of it alone, natural units
/// @param steps of the grid along each factor
Valley find_valley(const ResponseSurface& surface, double target, double tolerance,
                   const std::vector<double>& doubts, int steps = 61);

}  // namespace hoof::tools
