// A closed surface of triangles in its body's own frame.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace hoof::sim {

/// Vertices in metres, body frame B. Triangles list vertex indices counter-clockwise seen from
/// outside, so that (v1-v0) x (v2-v0) points out of the body.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices_m;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

}  // namespace hoof::sim
