// The sizes of a bed's grains.
#pragma once

#include <span>
#include <vector>

#include "sim/dem/grain.h"
#include "sim/terrain/bed_settings.h"

namespace hoof::sim {

/// Volume of a sphere, m^3.
double sphere_m3(double diameter_m);

/// Diameters of n grains of the grading, m: fixed quantiles of the number distribution, so that
/// beds of different seeds differ in packing alone.
std::vector<double> graded_diameters(const BedSettings& bed, std::size_t n);

/// Number of grains that fill the box to `share` solids times the overfill.
std::size_t grains_to_pour(const BedSettings& bed, double share);

/// Mass share of the grains in each class of bed.sieve, in its order. A grain on the edge of two
/// classes that touch counts to the coarser one.
std::vector<double> graded_shares(const BedSettings& bed, std::span<const Grain> grains);

}  // namespace hoof::sim
