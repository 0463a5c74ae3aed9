// Whether a mesh is a closed surface, and where it is not.
#pragma once

#include <optional>
#include <string>

#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

struct MeshFault {
  /// Index of a triangle at the fault.
  int triangle = 0;
  /// What is wrong there, with vertex coordinates in mm.
  std::string text;
};

/// Empty for one or more closed surfaces: every edge shared by exactly two triangles that run along
/// it in opposite directions, no triangle without area, a positive volume (normals outward).
std::optional<MeshFault> find_mesh_fault(const TriangleMesh& mesh);

}  // namespace hoof::sim
