// Start states that both codes get, and our engine's settings for them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tests/sim/dem/paper_bed.h"

namespace hoof::sim::test {

/// Who the grains of a case meet.
enum class Partner { kGrain, kPlane, kMesh };

/// Grains that fly for `steps` steps, `traced` of them watched all the way.
struct FreeCase {
  std::string name;  // of its record
  Partner partner = Partner::kGrain;
  std::vector<Grain> grains;
  std::vector<std::string> labels;  // by grain: what it is
  std::uint32_t traced = 0;
  int steps = 0;
  TriangleMesh mesh;
};

/// Pairs at -80 to 80 degrees, 0.05 to 3 m/s, of unlike sizes, with and without spin, the line of
/// centres turned anyhow.
FreeCase oblique_pairs();

/// Grains at -80 to 80 degrees on the plane z = 0, with and without spin.
FreeCase oblique_impacts_on_plane();

/// The same impacts on the top of a box of twelve triangles (some on its diagonal).
FreeCase oblique_impacts_on_mesh();

/// Grains that meet the edges and the corners of that box.
FreeCase impacts_on_edges();

DemSettings settings_of(const FreeCase& c, Precision precision);

}  // namespace hoof::sim::test
