// The drop laboratory: grains fall on an inclined plate, bounce off it, and land behind it.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/config/materials.h"

namespace hoof::tools {

struct DropTest {
  double height_m = 0.04042;        // fall of the centre from rest to the impact
  double height_after_m = 0.04042;  // from the centre at the impact down to where it lands
  double plate_rad = 0.7853981633974483;
  int grains = 1;          // each falls alone; several have the sizes of the paper's grading
  double spread_m = 0;     // places of release, along x: within +- this, evenly distributed
  std::uint64_t seed = 1;  // of these places

  /// @throws std::invalid_argument naming the first broken rule, its value and bound
  void validate() const;
};

struct DropOutcome {
  std::vector<double> travel_m;  // L: horizontal, from the middle of the impacts to the landing
  double kept_normal = 0;        // speed after over before the impact, mean over the grains
  double kept_tangential = 0;
  double rim_share = 0;  // rim speed of the spin after the impact over tangential speed before it
};

/// Restitution and friction are those of materials.sand_abs.
/// @throws std::runtime_error where a grain does not come off the plate or does not land
DropOutcome drop(const sim::Materials& materials, const DropTest& test);

}  // namespace hoof::tools
