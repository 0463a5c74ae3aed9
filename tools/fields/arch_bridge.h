// The "arch bridge" by which the paper explains that toes opened to 30 degrees sink least: sand
// between two toes that hangs between them by chains of grains and so carries as if it were sole.
#pragma once

#include "tools/fields/field_scene.h"

namespace hoof::tools {

/// Contacts that press with more than the mean of all in a region: the strong network, which
/// carries what goes beyond an even pressure (F. Radjai et al., Phys. Rev. Lett. 80 (1998), 61-64).
struct ForceChains {
  int contacts = 0;
  double mean_N = 0;  // of normal forces
  int strong = 0;
  double strong_share = 0;  // of the sum of normal forces
  double largest_N = 0;
};
/// Of the contacts whose middle lies in the zone under the foot.
ForceChains force_chains(const FieldScene& scene);

/// Chains of strong contacts that lead from under one body of the foot to under another and on the
/// way only over grains whose middles lie in the gap between them; a grain that a body touches
/// counts as under it. From the height of the soles down to the bottom of the zone under the foot;
/// strong against the mean there, gap included.
struct ArchBridge {
  double gap_area_m2 = 0;  // of the plan, between different bodies
  int paths = 0;           // that share no contact
  /// The largest flow from body to body if each contact may carry its normal force: what the chains
  /// could pass on together, N.
  double force_N = 0;
};
ArchBridge arch_bridge(const FieldScene& scene);

}  // namespace hoof::tools
