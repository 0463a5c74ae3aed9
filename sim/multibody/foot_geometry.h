// Lengths of a parametric foot and the closed meshes made from them.
#pragma once

#include "sim/config/reader.h"
#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

/// A flat-soled block with rounded bottom edges, longest in x.
struct SoleGeometry {
  double length_m = 0.0;
  double width_m = 0.0;
  double height_m = 0.0;
  double edge_radius_m = 0.0;
};

/// A toe from its hinge line (x = 0) forward to its tip, tapering from width to tip width.
struct ToeGeometry {
  double length_m = 0.0;
  double width_m = 0.0;
  double tip_width_m = 0.0;
  double height_m = 0.0;
  double edge_radius_m = 0.0;
  /// Hinge of the left toe: forward of the heel of the middle segment, to the left of its middle.
  double hinge_from_heel_m = 0.0;
  double hinge_lateral_m = 0.0;
};

/// Raked truncated pyramids below the sole, their tips to the rear.
struct SpineGeometry {
  /// Along the axis of a spine, from the sole to the tip.
  double length_m = 0.0;
  /// Side of the square section at the sole and at the tip.
  double base_m = 0.0;
  double tip_m = 0.0;
  /// Axis from the vertical, tip towards -x.
  double rake_rad = 0.0;
  /// One row along the middle of each toe.
  int toe_count = 0;
  double toe_pitch_m = 0.0;
  /// Two rows under the middle segment, staggered by half a pitch.
  int middle_count_row = 0;
  double middle_pitch_m = 0.0;
  double middle_row_offset_m = 0.0;
};

struct FootGeometry {
  SoleGeometry middle;
  bool has_toes = false;
  ToeGeometry toe;
  bool has_spines = false;
  SpineGeometry spines;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;
};

/// Frame F: origin in the middle of the sole, x forward, z up, flat of the sole at z = 0.
TriangleMesh make_middle(const FootGeometry& geometry);
/// Frame T0 or T1 (the same mesh serves both, being symmetric in y): origin on the hinge.
TriangleMesh make_toe(const FootGeometry& geometry);

}  // namespace hoof::sim
