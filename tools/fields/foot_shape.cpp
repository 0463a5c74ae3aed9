#include "tools/fields/foot_shape.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace hoof::tools {
namespace {

/// Pieces of a mesh: for each vertex the smallest vertex that it is joined to.
std::vector<std::int32_t> pieces(const sim::TriangleMesh& mesh) {
  std::vector<std::int32_t> root(mesh.vertices_m.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&root](std::int32_t v) {
    while (root[std::size_t(v)] != v)
      v = root[std::size_t(v)] = root[std::size_t(root[std::size_t(v)])];
    return v;
  };
  for (const auto& t : mesh.triangles) {
    for (const int k : {1, 2}) {
      const auto [low, high] = std::minmax({find(t[0]), find(t[std::size_t(k)])});
      root[std::size_t(high)] = low;
    }
  }
  for (std::size_t v = 0; v < root.size(); ++v) root[v] = find(std::int32_t(v));
  return root;
}

std::int32_t largest_piece(const sim::TriangleMesh& mesh, const std::vector<std::int32_t>& root) {
  std::map<std::int32_t, Eigen::AlignedBox3d> boxes;
  for (std::size_t v = 0; v < root.size(); ++v) boxes[root[v]].extend(mesh.vertices_m[v]);
  return std::max_element(
             boxes.begin(), boxes.end(),
             [](const auto& a, const auto& b) { return a.second.volume() < b.second.volume(); })
      ->first;
}

Eigen::Vector3d doubled_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             const Eigen::Vector3d& c) {
  return (b - a).cross(c - a);
}

std::vector<FootPart> parts_of(const sim::TriangleMesh& mesh, bool has_spines) {
  constexpr double kDown = 0.70710678118654752;  // cos 45 degrees
  const std::vector<std::int32_t> root = pieces(mesh);
  const std::int32_t block = largest_piece(mesh, root);
  std::vector<FootPart> parts;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int k) { return mesh.vertices_m[std::size_t(t[std::size_t(k)])]; };
    const Eigen::Vector3d n = doubled_area(at(0), at(1), at(2));
    if (has_spines && root[std::size_t(t[0])] != block) {
      parts.push_back(FootPart::kSpine);
    } else {
      parts.push_back(-n.z() > kDown * n.norm() ? FootPart::kSole : FootPart::kUpper);
    }
  }
  return parts;
}

}  // namespace

FootShape FootShape::of(std::vector<sim::TriangleMesh> meshes, bool has_spines) {
  FootShape shape;
  for (const sim::TriangleMesh& mesh : meshes) shape.parts.push_back(parts_of(mesh, has_spines));
  shape.meshes = std::move(meshes);
  return shape;
}

PlacedFoot::PlacedFoot(const FootShape& shape, const std::vector<sim::Pose>& poses) {
  for (std::size_t body = 0; body < shape.meshes.size(); ++body) {
    const sim::TriangleMesh& mesh = shape.meshes[body];
    const Eigen::Matrix3d R_WB = poses[body].q_WB.toRotationMatrix();
    first_triangle.push_back(triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      FootTriangle t;
      t.body = int(body);
      t.part = shape.parts[body][i];
      for (std::size_t k = 0; k < 3; ++k) {
        t.corners_m[k] =
            poses[body].p_WB_m + R_WB * mesh.vertices_m[std::size_t(mesh.triangles[i][k])];
      }
      const Eigen::Vector3d n = doubled_area(t.corners_m[0], t.corners_m[1], t.corners_m[2]);
      t.area_m2 = 0.5 * n.norm();
      if (t.area_m2 > 0) t.normal = n.normalized();
      triangles.push_back(t);
    }
  }
}

double PlacedFoot::lowest_m() const {
  double lowest_m = 1e9;
  for (const FootTriangle& t : triangles) {
    for (const Eigen::Vector3d& p : t.corners_m) lowest_m = std::min(lowest_m, p.z());
  }
  return lowest_m;
}

}  // namespace hoof::tools
