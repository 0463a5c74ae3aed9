// What the sand presses on the foot with, triangle by triangle.
#pragma once

#include "tools/fields/field_scene.h"

namespace hoof::tools {

/// p_k = F_n,k / A_k: sum of the normal forces of the contacts whose nearest point lies on triangle
/// k, over its area; for every triangle of the foot in the order of PlacedFoot. As the paper's
/// plots (figures 14 and 27), which colour the triangles of the foot's own mesh: the finer the mesh
/// against the grains, the higher and the fewer the peaks.
std::vector<double> triangle_pressure_Pa(const FieldScene& scene);

struct SolePressure {
  double plantar_area_m2 = 0;  // of sole and spines
  double touched_area_m2 = 0;  // of their triangles that carry a contact
  /// True contact area, sum pi a^2, a^2 = R delta (Hertz 1882; on a flat R is the grain's radius).
  double hertz_area_m2 = 0;
  double normal_force_N = 0;  // of sole and spines
  double peak_Pa = 0;         // largest of the triangles
  /// The foot's vertical load over the area that it covers: what each part would bear if all bore
  /// alike. Triangles above it are called high: the paper gives no threshold, and this one needs no
  /// number of ours, follows the load, and is the same for closed and opened toes.
  double threshold_Pa = 0;
  double high_share = 0;  // of the plantar area
  /// Of the vertical load: what the spines carry. NaN without a load.
  double spine_load_share = 0;
};
SolePressure sole_pressure(const FieldScene& scene);

/// Share of the plantar area that bears more than p_Pa.
double share_above(const FieldScene& scene, const std::vector<double>& pressure_Pa, double p_Pa);

/// The least pressure that less than `share` of the plantar area is above: the threshold at which
/// the paper's share would be met.
double pressure_of_share_Pa(const FieldScene& scene, const std::vector<double>& pressure_Pa,
                            double share);

}  // namespace hoof::tools
