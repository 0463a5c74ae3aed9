// The simplest closed mesh.
#pragma once

#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

/// Edge along each axis as given, one corner at `corner_m`.
inline TriangleMesh make_cuboid(const Eigen::Vector3d& corner_m, const Eigen::Vector3d& size_m) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d unit(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    mesh.vertices_m.push_back(corner_m + unit.cwiseProduct(size_m));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

}  // namespace hoof::sim
