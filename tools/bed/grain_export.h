// A bed's grains, contacts and meshes for other programs to look at.
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "sim/dem/triangle_mesh.h"
#include "sim/terrain/bed_contacts.h"
#include "tools/bed/vtk_file.h"

namespace hoof::tools {

/// Which grains are shown.
struct GrainSelection {
  struct Box {
    Eigen::Vector3d low_m, high_m;  // of centres, both ends included
  };
  std::optional<Box> region;
  std::uint32_t every = 1;  // those whose id is a multiple

  bool holds(const sim::Grain& grain) const;
};

/// Points with the arrays of a LIGGGHTS dump: id, type (1), radius, v, omega, f; SI units. f is the
/// sum of the contact forces, without the weight.
PolyData grain_points(const sim::DemSettings& settings, const sim::BedState& state,
                      const GrainSelection& selection);

/// Lines from centre to centre, or to the wall, with the arrays id1, id2 (walls: -1 - index),
/// force, force_normal, force_tangential (on id1, N) and delta (overlap, m). A pair is shown where
/// both its grains are selected; across periodic sides the line leaves the box at id1's side.
PolyData contact_lines(const sim::DemSettings& settings, const sim::BedState& state,
                       const GrainSelection& selection);

PolyData mesh_triangles(const sim::TriangleMesh& mesh, const Eigen::Vector3d& p_WB_m,
                        const Eigen::Quaterniond& q_WB);

/// One row a grain, all digits: id, radius_m, x_m ... wz_rad_s, fx_N ...
/// @throws UserError
void write_grain_csv(const std::filesystem::path& file, const sim::DemSettings& settings,
                     const sim::BedState& state, const GrainSelection& selection);

}  // namespace hoof::tools
