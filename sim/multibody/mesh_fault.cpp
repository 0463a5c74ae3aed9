#include "sim/multibody/mesh_fault.h"

#include <Eigen/Geometry>
#include <cstdio>
#include <map>
#include <utility>

#include "sim/multibody/mass_properties.h"

namespace hoof::sim {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;

std::string point_text(const Eigen::Vector3d& point_m) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.3f %.3f %.3f)", point_m.x() * 1e3, point_m.y() * 1e3,
                point_m.z() * 1e3);
  return text;
}

std::string edge_text(const TriangleMesh& mesh, const Edge& edge) {
  return "edge " + point_text(mesh.vertices_m[edge.first]) + " to " +
         point_text(mesh.vertices_m[edge.second]) + " mm";
}

std::optional<MeshFault> find_bad_triangle(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int32_t>(mesh.vertices_m.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const int index = static_cast<int>(t);
    for (const std::int32_t v : {a, b, c}) {
      if (v < 0 || v >= count) return MeshFault{index, "names a vertex that does not exist"};
      if (!mesh.vertices_m[v].allFinite())
        return MeshFault{index, "has a vertex that is no number"};
    }
    const Eigen::Vector3d& v0 = mesh.vertices_m[a];
    // 1e-15 m2 is a micrometre by a nanometre: less than rounding leaves of a real triangle.
    if ((mesh.vertices_m[b] - v0).cross(mesh.vertices_m[c] - v0).norm() < 1e-15) {
      return MeshFault{index, "at " + point_text(v0) + " mm has no area"};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<MeshFault> find_mesh_fault(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return MeshFault{0, "is missing: the mesh is empty"};
  if (auto fault = find_bad_triangle(mesh)) return fault;

  std::map<Edge, int> triangle_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Edge edge{mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]};
      const auto [other, is_new] = triangle_of.emplace(edge, static_cast<int>(t));
      if (is_new) continue;
      return MeshFault{static_cast<int>(t), edge_text(mesh, edge) +
                                                " runs the same way as in triangle " +
                                                std::to_string(other->second + 1) +
                                                ": one is turned over or there twice"};
    }
  }
  for (const auto& [edge, triangle] : triangle_of) {
    if (triangle_of.contains({edge.second, edge.first})) continue;
    return MeshFault{triangle, edge_text(mesh, edge) + " has no neighbour: the mesh has a hole"};
  }
  if (volume_m3(mesh) <= 0.0) {
    return MeshFault{0, "and all others face inward: the volume is negative"};
  }
  return std::nullopt;
}

}  // namespace hoof::sim
