// What a bed of sand is made of and how: grading, box, packing.
#pragma once

#include <string>
#include <vector>

#include "sim/config/materials.h"
#include "sim/config/reader.h"
#include "sim/dem/sand_bed.h"
#include "sim/terrain/bed_sieve_table.h"

namespace hoof::sim {

/// Solids over volume of the bed that is aimed at, and that the amount poured follows from: the
/// paper's count and grading fill its box to its 120 mm at this share.
inline constexpr double kSettledShare = 0.60;

/// The bed stands on its floor z = -depth_m, centred about x = y = 0, its level surface z = 0.
struct BedSettings {
  std::string name;
  double box_length_m = 0;  // x
  double box_width_m = 0;   // y
  double depth_m = 0;
  bool periodic_sides = false;
  std::vector<SieveClass> sieve;
  double grain_scale = 1;  // diameters of the table times this
  int steps_per_ms = 360;
  int settling_steps_per_ms = 180;  // while it is made: nothing is measured then
  double skin_m = 0;  // see DemSettings; 0: chosen while running
  // mu_s and mu_r while the grains fall: the less, the denser the bed.
  double packing_friction = 0.52;
  double packing_rolling_friction = 0.02;
  // Solids over volume of the column that falls: the more, the less far it falls. Random places
  // are found up to about 0.35 where all grains are alike, 0.47 where they are the paper's.
  double rain_share = 0.45;
  double overfill = 1.08;  // solids poured over solids of the levelled bed
  CoulombCap coulomb_cap = CoulombCap::kTotalNormal;
  RollingLaw rolling_law = RollingLaw::kOwnSpin;
  Precision precision = Precision::kMixed;

  double step_s() const { return 1e-3 / steps_per_ms; }
  double settling_step_s() const { return 1e-3 / settling_steps_per_ms; }
  double smallest_diameter_m() const { return grain_scale * sieve.front().low_m; }
  double largest_diameter_m() const { return grain_scale * sieve.back().high_m; }
  /// Half of the mass is in smaller grains.
  double d50_m() const;

  /// @throws std::invalid_argument naming the first broken rule, value and bound
  void validate() const;
};

/// Reads the section "bed" of a run. @throws ConfigError
BedSettings read_bed(Reader section);

/// Constants for the engine: domain, walls (floor first, then -x +x -y +y, lid last) and laws.
DemSettings dem_settings(const BedSettings& bed, const Materials& materials, int threads);

}  // namespace hoof::sim
