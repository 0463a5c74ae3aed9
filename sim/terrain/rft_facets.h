// The surface of a body as few, small facets for a law of stress per facet.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

struct RftFacet {
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_B = Eigen::Vector3d::UnitZ();  // unit, out of the body
  double area_m2 = 0;
};

/// Triangles are cut to half of size_m; pieces within half of size_m of each other whose normals
/// are within 20 degrees become one facet, if they lie in about one plane. Vector areas are kept,
/// so that a uniform pressure on a closed mesh gives no force. The order follows the mesh's.
/// @throws std::invalid_argument where the mesh has no area
std::vector<RftFacet> make_facets(const TriangleMesh& mesh, double size_m);

}  // namespace hoof::sim
