// How the grains under the foot lie: contacts per grain, share of solids.
#pragma once

#include <functional>

#include "tools/fields/field_scene.h"

namespace hoof::tools {

struct Coordination {
  int grains = 0;
  /// Z = mean number of partners, foot and walls counted as one each.
  double mean = 0;
  /// Z_m = (2 N_c - N_1) / (N - N_0 - N_1) with N_c contacts per pair, N_0 and N_1 grains with no
  /// and one partner, which take no part in carrying: C. Thornton, Geotechnique 50 (2000), 43-53.
  /// Summed over the grains asked for, 2 N_c is their partners.
  double mechanical = 0;
};
Coordination coordination(const FieldScene& scene,
                          const std::function<bool(const Eigen::Vector3d&)>& holds);

/// Volume of the grains inside of a region, m3: each grain by the share of its points inside, the
/// middles of the cells of a lattice of 1/8 of its diameter. A grain cut in half gives half.
double solid_volume_m3(const std::vector<sim::Grain>& grains,
                       const std::function<bool(const Eigen::Vector3d&)>& holds);

}  // namespace hoof::tools
