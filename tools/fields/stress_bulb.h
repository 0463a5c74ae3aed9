// How deep a foot's load is felt, and over what area.
#pragma once

#include <optional>

#include "tools/fields/sand_stress.h"

namespace hoof::tools {

/// Vertical stress added since the contact under the foot's plan, against depth below the foot's
/// lowest point, in layers of d50 / 2: as shares of the load over the plan's area.
struct StressBulb {
  static constexpr double kEdge = 0.1;  // where the bulb ends
  /// Less load than this many weights of the sand in the zone under the foot is lost in what that
  /// sand bears already and shifts as it is stirred: no shares then.
  static constexpr double kLeast_weights = 3;

  double nominal_Pa = 0;          // load over the plan's area
  double layer_m = 0;             // thickness
  std::vector<double> share;      // of the nominal; layer k lies about (k + 1/2) layer_m deep
  std::vector<double> gap_share;  // the same under gaps, as if they were sole; empty without gap
  /// Depth from which on all shares are below kEdge; empty where it is not met above the floor.
  std::optional<double> depth_m;
};

/// The end of a bulb from its shares, by the straight line between the layers about it.
std::optional<double> bulb_depth_m(const std::vector<double>& share, double layer_m, double edge);

/// @param before the sand at first contact
StressBulb stress_bulb(const FieldScene& scene, const FieldScene& before);

}  // namespace hoof::tools
