// Mass, centre and inertia of rigid bodies.
#pragma once

#include <Eigen/Core>

#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

/// Of a body in its frame B.
struct MassProperties {
  double mass_kg = 0.0;
  Eigen::Vector3d com_B_m = Eigen::Vector3d::Zero();
  /// About the centre of mass, axes of B.
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();
};

/// Enclosed volume: sum of the signed tetrahedra of the triangles with the origin (divergence
/// theorem). Overlapping parts of a mesh count twice.
double volume_m3(const TriangleMesh& mesh);

/// A closed mesh filled with one density.
MassProperties solid(const TriangleMesh& mesh, double mass_kg);

/// Two parts fixed to each other, given in the same frame.
MassProperties joined(const MassProperties& a, const MassProperties& b);

}  // namespace hoof::sim
