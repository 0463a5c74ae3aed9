// What a made bed is like.
#pragma once

#include <cstddef>

#include "sim/terrain/bed_settings.h"

namespace hoof::sim {

struct BedReport {
  std::size_t grains = 0;
  double solids_kg = 0;
  double solid_share = 0;  // of the layer between a tenth and nine tenths of the depth
  double coordination_number = 0;
  double largest_cell_deviation = 0;  // of grain counts over 4 x 3 x 1 regions, from their mean
  double kinetic_energy_J = 0;
};

BedReport inspect_bed(const BedSettings& bed, const Materials& materials, const BedState& state);

}  // namespace hoof::sim
