// From a sieve table to a settled, level bed.
#pragma once

#include <cstdint>
#include <functional>

#include "sim/terrain/bed_settings.h"

namespace hoof::sim {

/// What a bed is like; printed in bed reports.
struct BedReport {
  std::size_t grains = 0;
  double solids_kg = 0;
  double solid_share = 0;  // of the layer between a tenth and nine tenths of the depth
  double coordination_number = 0;
  double largest_cell_deviation = 0;  // of grain counts over 4 x 3 x 1 regions, from their mean
  double kinetic_energy_J = 0;
};

/// Called now and then with the share of the work done; returns false to stop.
using BedProgress = std::function<bool(double)>;

/// Diameters of n grains of the grading, m: fixed quantiles of the number distribution, so that
/// beds of different seeds differ in packing alone.
std::vector<double> graded_diameters(const BedSettings& bed, std::size_t n);

/// Number of grains that fill the box to `share` solids times the overfill.
std::size_t grains_to_pour(const BedSettings& bed, double share);

/// Grains without overlaps, all over a column above the floor. @throws std::runtime_error if they
/// do not fit
std::vector<Grain> rain(const BedSettings& bed, double column_m, std::uint64_t seed);

/// Pours, settles, scrapes level and lets come to rest.
/// @throws std::runtime_error "stopped" when progress says so
BedState make_bed(const BedSettings& bed, const Materials& materials, std::uint64_t seed,
                  int threads, const BedProgress& progress);

BedReport inspect_bed(const BedSettings& bed, const Materials& materials, const BedState& state);

}  // namespace hoof::sim
