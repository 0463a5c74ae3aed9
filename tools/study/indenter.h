// What a study presses into the sand: a slice of the foot's sole, or the whole foot.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/dem/triangle_mesh.h"
#include "sim/multibody/foot.h"

namespace hoof::tools {

/// Bodies that go down as one, placed so that the flat of the sole is at z = 0 and its middle at
/// x = y = 0.
struct Indenter {
  struct Part {
    sim::TriangleMesh mesh;
    Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
    double yaw_rad = 0;  // about +z
  };
  std::string name;
  std::vector<Part> parts;

  /// z of the lowest point: 0 for a plain sole, minus the depth of the spines for a spined one.
  double lowest_m() const;
};

/// The foot's middle segment made endless along y by the bed's period: plane strain, the cheap
/// model of a long sole. Its width lies along x. Spines stand as under the foot: two rows,
/// staggered by half a pitch, so the period must be a whole number of pitches.
/// @throws std::invalid_argument where it is not
Indenter make_strip(const sim::FootGeometry& foot, double period_m, bool spined);

/// The whole foot with its toes opened by toe_rad a side.
/// @param spined false leaves the spines off
Indenter make_foot(const sim::Foot& foot, double toe_rad, bool spined);

}  // namespace hoof::tools
