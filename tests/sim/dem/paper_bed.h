// The paper's grains (sand on sand, sand on ABS; sim/config/materials holds the sources) and small
// helpers, for tests of the engine alone.
#pragma once

#include <string>
#include <vector>

#include "sim/dem/sand_bed.h"

namespace hoof::sim::test {

inline DemSettings paper_settings(double half_size_m = 0.05) {
  DemSettings s;
  s.low_m = Eigen::Vector3d::Constant(-half_size_m);
  s.high_m = Eigen::Vector3d::Constant(half_size_m);
  s.grain_material = {178.5e6, 0.25, 2650};
  s.wall_material = {2.02e9, 0.37, 1050};
  s.grain_grain = {0.54, 0.52, 0.34};
  s.grain_wall = {0.5636, 0.5929, 0.0408};
  s.gravity_m_s2.setZero();
  s.dt_s = 2.8e-6;
  return s;
}

inline Grain grain_at(std::uint32_t id, double diameter_m, const Eigen::Vector3d& p_m,
                      const Eigen::Vector3d& v_m_s = Eigen::Vector3d::Zero(),
                      const Eigen::Vector3d& w_rad_s = Eigen::Vector3d::Zero()) {
  return {id, diameter_m / 2, p_m, v_m_s, w_rad_s};
}

inline double grain_mass_kg(double diameter_m) {
  return 2650 * 3.14159265358979323846 / 6 * diameter_m * diameter_m * diameter_m;
}

/// An axis-aligned box of twelve triangles about its own origin, normals outward.
inline TriangleMesh box_mesh(const Eigen::Vector3d& half_m) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices_m.emplace_back((i & 1 ? 1 : -1) * half_m.x(), (i & 2 ? 1 : -1) * half_m.y(),
                                 (i & 4 ? 1 : -1) * half_m.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

}  // namespace hoof::sim::test
