// The foot's triangles: which are sole, which are spines, and where they are at a moment.
#pragma once

#include <vector>

#include "sim/dem/triangle_mesh.h"
#include "sim/terrain/terrain.h"

namespace hoof::tools {

enum class FootPart { kUpper, kSole, kSpine };

/// Meshes of the foot's bodies with the part that each triangle belongs to. A spine is a closed
/// piece of its own beside the largest piece of its body (as the parametric feet are made). Sole is
/// what of the largest piece looks down by more than 45 degrees, rounded edges included. Bodies
/// stand upright in their frames.
struct FootShape {
  std::vector<sim::TriangleMesh> meshes;
  std::vector<std::vector<FootPart>> parts;  // by body and triangle

  /// @param has_spines false: pieces beside the largest are not taken for spines (feet from files)
  static FootShape of(std::vector<sim::TriangleMesh> meshes, bool has_spines);
};

struct FootTriangle {
  int body = 0;
  FootPart part = FootPart::kUpper;
  Eigen::Vector3d corners_m[3];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // out of the foot
  double area_m2 = 0;

  bool plantar() const { return part != FootPart::kUpper; }
};

struct PlacedFoot {
  std::vector<FootTriangle> triangles;      // body after body
  std::vector<std::size_t> first_triangle;  // of each body

  PlacedFoot(const FootShape& shape, const std::vector<sim::Pose>& poses);

  const FootTriangle& triangle(std::uint32_t body, std::uint32_t triangle) const {
    return triangles[first_triangle[body] + triangle];
  }
  double lowest_m() const;
};

}  // namespace hoof::tools
