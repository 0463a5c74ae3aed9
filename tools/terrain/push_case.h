// One push of a plate into sand: where it starts, where it goes, and the forces met on the way.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "sim/dem/triangle_mesh.h"
#include "sim/terrain/terrain.h"

namespace hoof::tools {

/// Angles as in sim/terrain/rft_law.h: the pushing face has the normal (sin beta cos psi,
/// sin beta sin psi, -cos beta) and goes along (cos gamma, 0, -sin gamma).
struct PushCase {
  std::string name;
  double length_m = 0;  ///< along x before it is tilted about y
  double width_m = 0;
  double thickness_m = 0;
  double beta_rad = 0, psi_rad = 0, gamma_rad = 0;
  double insert_m = 0;  ///< straight down before the push: the lowest point's depth then
  double way_m = 0;     ///< of the push
  double back_m = 0;    ///< the way straight back after it: unloading
  bool held_out = false;

  /// b of Bekker's law.
  double smaller_width_m() const { return length_m < width_m ? length_m : width_m; }
  sim::TriangleMesh mesh() const;
  Eigen::Quaterniond q_WB() const;
  /// Unit vector of the push.
  Eigen::Vector3d direction() const;
  /// Of the centre, so that the path's middle is over x = 0.
  Eigen::Vector3d start_m() const;
  /// Half of the box that plate and path fill, x and y.
  Eigen::Vector2d half_extent_m() const;
};

enum class PushPhase { kInsert, kPush, kBack };

struct PushSample {
  PushPhase phase = PushPhase::kPush;
  double way_m = 0;                  ///< in the middle of the interval, since the phase began
  Eigen::Vector3d force_N{0, 0, 0};  ///< of the sand on the plate, mean over the interval
};

struct Push {
  PushCase plate;
  std::vector<PushSample> samples;  ///< of the push and the way back
};

/// The straight parts of a push and into how many equal intervals each is cut.
struct PushLeg {
  PushPhase phase = PushPhase::kPush;
  Eigen::Vector3d way_m{0, 0, 0};
  int intervals = 1;
};
std::vector<PushLeg> legs_of(const PushCase& plate);

/// The plates of a fit. Every third is held out, so that both sets have all kinds.
/// @param scale lengths times this
std::vector<PushCase> standard_pushes(double scale);

}  // namespace hoof::tools
