// What a bed can and cannot tell: lengths of foot and test over the grain size, and the box over
// the foot. The bounds come from the studies of RESOLUTION.md beside this file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/experiments/traction.h"
#include "sim/multibody/foot_geometry.h"
#include "sim/terrain/bed_settings.h"

namespace hoof::sim {

struct Resolution {
  std::optional<double> spine_pitch_over_d50;
  std::optional<double> sole_width_over_d50;
  double sinkage_over_d50 = 0;
  double box_length_over_foot = 0;
  double box_width_over_foot = 0;
  double bed_depth_over_foot_width = 0;
  /// In words, each with the ratio and the bound that it misses.
  std::vector<std::string> claims_refused;
};

/// @param footprint_x_m, footprint_y_m outer size of the foot on the ground, toes as opened
Resolution assess_resolution(const BedSettings& bed, const FootGeometry& foot, double footprint_x_m,
                             double footprint_y_m, double sinkage_m);

/// For people before a long run: each line names a side of the box that is too small for this foot,
/// its bound, and by how much forces in it may be off. Empty where the box is large enough.
std::vector<std::string> box_warnings(const BedSettings& bed, double footprint_x_m,
                                      double footprint_y_m);

/// The least length of the box for a foot whose ends go reach_m to either side of its middle: the
/// largest grain fits between them and each end wall. In a shorter one a wall stops the foot.
double least_length_m(const BedSettings& bed, double reach_m);

/// As box_warnings, of the length that a foot needs that is pulled along a path: before an end wall
/// sand gives way as before a retaining wall as high as the foot's ends are deep. Empty where there
/// is room, or no wall.
std::string wall_warning(const BedSettings& bed, double reach_m, const StanceEllipse& path);

}  // namespace hoof::sim
