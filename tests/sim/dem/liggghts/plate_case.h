// A plate pressed into the settled bed of 20,000 grains (tests/data/dem/bed-20k.csv).
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "sim/dem/sand_bed.h"

namespace hoof::sim::test {

constexpr double kPlateSpeed_m_s = 0.4;
constexpr int kPlateBlock = 50;    // steps that each force is the mean of
constexpr int kPlateBlocks = 120;  // of the record: 6.7 mm

/// Mean force of the grains on the plate over steps 1-50, 51-100, ...
using PlateForces = std::vector<Eigen::Vector3d>;

/// Both codes start with the grains at rest and no contact history.
PlateForces press_ours(Precision precision, int blocks);
PlateForces press_liggghts(int blocks);

/// Records keep steps and forces: step,fx_N,fy_N,fz_N.
void write_forces(const std::filesystem::path& file, const PlateForces& forces);
PlateForces read_forces(const std::filesystem::path& file);

/// rms of |ours - theirs| over rms of |theirs|, blocks [begin, end).
double rms_difference(const PlateForces& ours, const PlateForces& theirs, std::size_t begin,
                      std::size_t end);
/// Sum of Fz, ours over theirs, less one.
double mean_difference(const PlateForces& ours, const PlateForces& theirs, std::size_t begin,
                       std::size_t end);

/// Catch checks of a whole run, bounds and their reasons there.
void check_whole_plate(const PlateForces& ours, const PlateForces& theirs);

}  // namespace hoof::sim::test
