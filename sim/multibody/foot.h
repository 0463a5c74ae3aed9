// A foot ready to be mounted on a rig: meshes, hinges, masses.
#pragma once

#include <string>
#include <vector>

#include "sim/config/reader.h"
#include "sim/dem/triangle_mesh.h"
#include "sim/multibody/foot_geometry.h"

namespace hoof::sim {

/// The two toes turn about +z and are driven together.
struct ToeHinges {
  /// Hinge of the left toe in F, on the sole plane; the right one is its mirror image in y.
  Eigen::Vector3d left_F_m = Eigen::Vector3d::Zero();
  /// End stops of the opening of each toe, positive outward.
  double min_opening_rad = 0.0;
  double max_opening_rad = 0.0;
  /// Linkage between the toes: a spring and damper on the difference of the two openings.
  double linkage_stiffness_Nm_rad = 0.0;
  double linkage_damping_Nm_s_rad = 0.0;
};

/// Meshes in their own frames: F for the middle (origin in the middle of the sole, x forward, z up,
/// sole at z = 0, spines below), T0 and T1 for the toes (origin on the hinge, x along the toe).
struct Foot {
  std::string name;
  TriangleMesh middle;
  bool has_toes = false;
  TriangleMesh left_toe;
  TriangleMesh right_toe;
  ToeHinges hinges;
  /// Of all parts; spread over them by volume (one density).
  double mass_kg = 0.0;
  /// Lengths the report needs; zero for a foot from an STL file.
  FootGeometry geometry;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;
};

/// The same foot with the ends of its spines worn off by loss_m along their axes: truncated, so
/// that their tips grow wider; gone where nothing is left. Its mass stays as stated.
/// @throws std::invalid_argument for a foot without spines of its own, as one from a mesh file
Foot with_worn_spines(Foot foot, double loss_m);

/// Reads the section "foot" of a run and makes the meshes. A foot with `mesh_file` is one rigid
/// body from that STL file; `toe` and `spines` are sections a foot may lack.
Foot read_foot(Reader section);

/// What a --foot option stands for as --set overrides: the name of a preset, or the path of an STL
/// file (a name that ends in .stl, in any case of letters).
std::vector<std::string> foot_overrides(const std::string& name_or_stl_file);

}  // namespace hoof::sim
