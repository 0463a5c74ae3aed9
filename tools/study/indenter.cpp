#include "tools/study/indenter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "sim/multibody/foot_geometry.h"

namespace hoof::tools {

double Indenter::lowest_m() const {
  double lowest = 0;
  for (const Part& part : parts) {
    for (const Eigen::Vector3d& v : part.mesh.vertices_m) {
      lowest = std::min(lowest, part.p_WB_m.z() + v.z());  // a yaw leaves z as it is
    }
  }
  return lowest;
}

Indenter make_strip(const sim::FootGeometry& foot, double period_m, bool spined) {
  sim::FootGeometry slice = foot;
  // The ends reach past the period by their rounding: there they lie within the image of the other
  // end, and where two images coincide a grain is pushed once (see Boundary::touch_meshes).
  slice.middle.length_m = period_m + 3 * foot.middle.edge_radius_m;
  slice.has_spines = spined;
  if (spined) {
    const double pitches = period_m / foot.spines.middle_pitch_m;
    slice.spines.middle_count_row = int(std::lround(pitches));
    if (std::abs(pitches - std::lround(pitches)) > 1e-9 || pitches < 0.5) {
      std::ostringstream text;
      text << "a slice of " << period_m * 1e3 << " mm is no whole number of spine pitches of "
           << foot.spines.middle_pitch_m * 1e3 << " mm";
      throw std::invalid_argument(text.str());
    }
  }
  return {spined ? "strip-spined" : "strip-plain",
          {{sim::make_middle(slice), Eigen::Vector3d::Zero(), std::numbers::pi / 2}}};
}

Indenter make_foot(const sim::Foot& foot, double toe_rad, bool spined) {
  sim::FootGeometry geometry = foot.geometry;
  geometry.has_spines = spined && geometry.has_spines;
  const int toe_deg = int(std::lround(toe_rad * 180 / std::numbers::pi));
  Indenter indenter{(spined ? "foot-spined-" : "foot-plain-") + std::to_string(toe_deg) + "deg",
                    {{sim::make_middle(geometry), Eigen::Vector3d::Zero(), 0}}};
  if (!foot.has_toes) return indenter;
  const sim::TriangleMesh toe = sim::make_toe(geometry);
  const Eigen::Vector3d hinge = foot.hinges.left_F_m;
  indenter.parts.push_back({toe, hinge, toe_rad});
  indenter.parts.push_back({toe, {hinge.x(), -hinge.y(), hinge.z()}, -toe_rad});
  return indenter;
}

}  // namespace hoof::tools
