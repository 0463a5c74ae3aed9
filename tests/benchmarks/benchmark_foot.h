// The foot that benchmarks press into sand.
#pragma once

#include "sim/dem/triangle_mesh.h"

namespace hoof::benchmarks {

/// A block of 60 x 30 x 40 mm with a rounded sole, 5,400 triangles, origin in the middle of the
/// sole, z up.
hoof::sim::TriangleMesh foot_mesh();

}  // namespace hoof::benchmarks
