// How the grains move: speed, kinetic energy and where it is, ways since the contact.
#pragma once

#include "tools/fields/field_scene.h"

namespace hoof::tools {

/// Mean weighted by mass, and the 99th percentile, which a single grain that jumps does not set.
struct Spread {
  double mean = 0, p99 = 0, largest = 0;
};
/// @param values, weights of the same places
Spread spread(std::vector<double> values, const std::vector<double>& weights);

/// The value below which `share` of the weight lies; 0 for no weight.
double weighted_quantile(std::vector<std::pair<double, double>> value_weight, double share);

/// 1/2 m v^2 + 1/2 I w^2 of a grain, I = 2/5 m r^2, J.
double kinetic_J(const FieldScene& scene, const sim::Grain& g);

/// Where the kinetic energy of the recorded grains is.
struct KineticExtent {
  static constexpr double kShare = 0.9;

  double total_J = 0;
  double depth_m = 0;   // below the level sand, above which kShare of it is
  double length_m = 0;  // along x and y, between the quantiles (1 - kShare) / 2 and the rest
  double width_m = 0;
  double volume_m3 = 0;  // of the fewest cells of `cell_m` that hold kShare
};
KineticExtent kinetic_extent(const FieldScene& scene, double cell_m);

/// Ways of the grains of `now` since `then`, by place in `now`; zero for those not recorded then.
std::vector<Eigen::Vector3d> displacements_m(const FieldMoment& then, const FieldMoment& now);

/// Rearward horizontal speed (-x: a foot that pulls its robot forward pushes sand to the rear) of
/// the grains at a part of the foot: those whose surface is within d50 / 2 of it.
struct RearwardSpeed {
  int grains = 0;
  double mean_m_s = 0;  // weighted by mass
  double largest_m_s = 0;
};
RearwardSpeed rearward_speed(const FieldScene& scene, FootPart part);

}  // namespace hoof::tools
