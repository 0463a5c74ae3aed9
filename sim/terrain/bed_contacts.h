// The forces in a bed at one moment, computed from its state alone by the contact law.
#pragma once

#include <vector>

#include "sim/dem/sand_bed.h"

namespace hoof::sim {

/// A touching pair, or a grain on a wall, as grain i feels it.
struct LoadedContact {
  std::uint32_t i = 0;
  std::uint32_t j = 0;  // partner's id; GrainContact::kWallContact + index for a wall
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();  // middle of the overlap
  Eigen::Vector3d to_j_m =
      Eigen::Vector3d::Zero();  // from the centre of i to that of j, or to the wall
  double overlap_m = 0;
  double overlap_ratio = 0;  // over the smaller radius
  Eigen::Vector3d f_normal_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d f_tangential_N = Eigen::Vector3d::Zero();
};

/// All contacts that touch, by (i, j). Positions, velocities and histories are taken as they stand:
/// the velocities are half a step older than the positions, which for sand at rest is nothing.
/// @throws std::invalid_argument where a contact names a grain or wall that is not there
std::vector<LoadedContact> loaded_contacts(const DemSettings& settings, const BedState& state);

/// Sum of the contact forces on each grain, N; in the order of state.grains.
std::vector<Eigen::Vector3d> forces_on_grains(const BedState& state,
                                              const std::vector<LoadedContact>& contacts);

}  // namespace hoof::sim
