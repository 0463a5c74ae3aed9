// The rolling laboratory: grains roll down an incline from rest, leave its edge and land.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/config/materials.h"

namespace hoof::tools {

struct RollTest {
  double incline_rad = 0.7853981633974483;
  double run_m = 0.0496;   // S1, along the incline from rest to the edge
  double fall_m = 0.0643;  // H4, from the centre over the edge down to where it lands
  int grains = 1;          // each rolls alone; several have the sizes of the paper's grading
  double spread_m = 0;     // places of release along the incline: within +- this, evenly
  std::uint64_t seed = 1;  // of these places

  /// @throws std::invalid_argument naming the first broken rule, its value and bound
  void validate() const;
};

struct RollOutcome {
  std::vector<double> travel_m;  // S2: horizontal, from the centre over the edge to the landing
  double edge_speed_m_s = 0;     // of the centre when it is over the edge, mean over the grains
  double rim_share = 0;          // rim speed over that: 1 is rolling without slip
};

/// @throws std::invalid_argument where the test is out of its bounds, or the rolling friction of
/// materials.sand_abs holds a grain on the incline
void require_rolling(const sim::Materials& materials, const RollTest& test);

/// Friction and restitution are those of materials.sand_abs.
/// @throws std::runtime_error where a grain does not roll to the edge or does not land
RollOutcome roll(const sim::Materials& materials, const RollTest& test);

}  // namespace hoof::tools
