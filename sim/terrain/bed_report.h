// What a made bed is like.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim/terrain/bed_settings.h"

namespace hoof::sim {

struct BedReport {
  static constexpr int kLayers = 10, kRegionsX = 4, kRegionsY = 3;

  std::size_t grains = 0;
  double solids_kg = 0;
  double solid_share = 0;  // of the layer between a tenth and nine tenths of the depth
  std::array<double, kLayers> layer_solid_share{};  // of tenths of the depth, from the floor up
  double coordination_number = 0;  // touching partners of a grain, walls not counted, on the mean
  std::array<std::size_t, kRegionsX * kRegionsY>
      region_grains{};                  // over 4 x 3 x 1 regions, x first
  double largest_region_deviation = 0;  // of the regions' counts, from their mean, over it
  std::vector<double> graded_share;     // mass share in each sieve class, in their order
  double largest_overlap_ratio = 0;     // over the smaller of two radii
  double kinetic_energy_J = 0;
  double energy_ratio = 0;     // kinetic energy over what lifts each grain by its own diameter
  double highest_grain_m = 0;  // its top, 0 being the level of the bed
};

BedReport inspect_bed(const BedSettings& bed, const Materials& materials, const BedState& state);

}  // namespace hoof::sim
