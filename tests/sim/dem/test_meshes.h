// Meshes of known shape, for tests of what touches them.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "sim/dem/triangle_mesh.h"

namespace hoof::sim::test {

/// A sheet z(x, y) over [-half_m, half_m]^2, cells x cells squares of two triangles each, normals
/// up.
inline TriangleMesh sheet_mesh(double half_m, int cells,
                               const std::function<double(double, double)>& z_m) {
  TriangleMesh mesh;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double x = -half_m + 2 * half_m * i / cells, y = -half_m + 2 * half_m * j / cells;
      mesh.vertices_m.emplace_back(x, y, z_m(x, y));
    }
  }
  const auto at = [&](int i, int j) { return std::int32_t(i * (cells + 1) + j); };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Every triangle cut in four; `place` puts the new vertices.
inline TriangleMesh refined(const TriangleMesh& mesh,
                            const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place) {
  TriangleMesh fine;
  fine.vertices_m = mesh.vertices_m;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle_of;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [entry, is_new] = middle_of.try_emplace(std::minmax(a, b), 0);
    if (is_new) {
      entry->second = std::int32_t(fine.vertices_m.size());
      fine.vertices_m.push_back(
          place(0.5 * (mesh.vertices_m[std::size_t(a)] + mesh.vertices_m[std::size_t(b)])));
    }
    return entry->second;
  };
  for (const auto& t : mesh.triangles) {
    const std::int32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    fine.triangles.push_back({t[0], ab, ca});
    fine.triangles.push_back({ab, t[1], bc});
    fine.triangles.push_back({ca, bc, t[2]});
    fine.triangles.push_back({ab, bc, ca});
  }
  return fine;
}

/// The same shape in more triangles.
inline TriangleMesh refined(const TriangleMesh& mesh) {
  return refined(mesh, [](const Eigen::Vector3d& p) { return p; });
}

/// A sphere about the origin: an octahedron cut in four `times` times, vertices on the sphere.
inline TriangleMesh sphere_mesh(double radius_m, int times) {
  TriangleMesh mesh;
  for (const int axis : {0, 1, 2}) {
    for (const double sign : {1.0, -1.0}) {
      mesh.vertices_m.push_back(sign * radius_m * Eigen::Vector3d::Unit(axis));
    }
  }
  for (const int x : {0, 1}) {
    for (const int y : {2, 3}) {
      for (const int z : {4, 5}) {
        const bool even = (x + y + z) % 2 == 0;
        mesh.triangles.push_back(even ? std::array<std::int32_t, 3>{x, y, z}
                                      : std::array<std::int32_t, 3>{x, z, y});
      }
    }
  }
  for (int i = 0; i < times; ++i) {
    mesh = refined(
        mesh, [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(radius_m * p.normalized()); });
  }
  return mesh;
}

}  // namespace hoof::sim::test
