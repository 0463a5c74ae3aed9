// Stress between grains, averaged over stated volumes.
//
// Love-Weber (the contact part of the virial), compression positive:
//   sigma_ab = 1/V sum_c w_c f_a l_b
// symbol  meaning                                                                unit
// f       force on grain i of the contact                                        N
// l       branch: centre of i minus the partner's centre (or the spot on a wall) m
// w       share of the branch that lies in V                                     1
// V       the averaging volume                                                   m3
// Source: A. E. H. Love, A Treatise on the Mathematical Theory of Elasticity (1927), note B; the
// share of the branch from I. Goldhirsch, Granular Matter 12 (2010), 239-252, with the volume's
// indicator as the coarse-graining function: whatever crosses the volume counts by the way it goes
// there, so that over a whole horizontal layer sigma_zz times the area is the layer's mean of the
// force that passes down. The motion's own part (rho v v, 0.3 kPa at 0.4 m/s) is left out.
#pragma once

#include <array>
#include <vector>

#include "tools/fields/field_scene.h"

namespace hoof::tools {

Eigen::Matrix3d box_stress_Pa(const std::vector<ForceLine>& lines,
                              const Eigen::AlignedBox3d& box_m);

/// Vertical force that passes down through layers, N, by what is above: mean over the layer's
/// thickness of the vertical force through its level.
struct LayerForces {
  double top_m = 0;  // of the first layer; the next lie below
  double thickness_m = 0;
  std::vector<double> foot_N, gap_N;  // under the foot's plan; under gaps between its bodies
};

/// @param plan whose plan counts: of the same moment, or of a later one over the sand of before
LayerForces layer_forces(const std::vector<ForceLine>& lines, const Footprint& plan, double top_m,
                         double thickness_m, int layers);

/// Cells of a grid in a cut along x and z: sigma_zz or any component averaged over `width_m` about
/// `y_m`. For maps.
struct StressCut {
  double low_x_m = 0, low_z_m = 0, cell_m = 0;
  int columns = 0, rows = 0;
  std::vector<double> zz_Pa;  // row after row from below
};
StressCut stress_cut(const std::vector<ForceLine>& lines, const Eigen::AlignedBox3d& slab_m,
                     double cell_m);

/// Area of the square cells of `cell_m` in a layer in which the vertical stress is above
/// `threshold_Pa`, and the participation area (sum s)^2 / sum s^2 times the cell, which needs no
/// threshold: that of a uniform stress is its own area. Of the stress added since `before`.
struct SupportArea {
  double above_m2 = 0;
  double participation_m2 = 0;
};
SupportArea support_area(const std::vector<ForceLine>& lines, const std::vector<ForceLine>& before,
                         const Eigen::AlignedBox3d& layer_m, double cell_m, double threshold_Pa);

}  // namespace hoof::tools
