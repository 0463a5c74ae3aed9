// A grain as the outside world sees it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace hoof::sim {

struct Grain {
  std::uint32_t id = 0;  // unique within a bed
  double radius_m = 0;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_m_s = Eigen::Vector3d::Zero();  // half a step before the position (leapfrog)
  Eigen::Vector3d w_rad_s = Eigen::Vector3d::Zero();
};

/// Tangential displacement of a touching pair, seen from grain i (i < j), or of grain i on a wall.
struct GrainContact {
  std::uint32_t i = 0;
  std::uint32_t j = 0;  // partner's id; kWallContact + index for a wall
  Eigen::Vector3d xi_m = Eigen::Vector3d::Zero();

  static constexpr std::uint32_t kWallContact = 0xffffff00;
};

/// Everything that a bed remembers between steps, but meshes.
struct BedState {
  std::vector<Grain> grains;           // by id
  std::vector<GrainContact> contacts;  // by (i, j)
};

}  // namespace hoof::sim
