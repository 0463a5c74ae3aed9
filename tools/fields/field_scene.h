// A moment worked out once for all that is measured in it: forces between grains, the foot's
// triangles, who is under it.
#pragma once

#include <vector>

#include "tools/fields/field_moment.h"
#include "tools/fields/foot_shape.h"
#include "tools/fields/footprint.h"

namespace hoof::tools {

/// A contact as a line that carries a force: from the centre of grain i to that of grain j, or to
/// the spot on foot or wall. Pressing forces point from `to` to `from`.
struct ForceLine {
  static constexpr std::int32_t kFoot = -1, kWall = -2;

  std::int32_t i = 0;  // places in the moment's grains
  std::int32_t j = 0;
  std::int32_t body = -1;  // of the foot, where j is kFoot
  Eigen::Vector3d from_m, to_m;
  Eigen::Vector3d f_N;    // on i
  double f_normal_N = 0;  // positive where it presses
  double overlap_m = 0;
};

/// What all moments of a run have in common.
struct FieldSetting {
  sim::DemSettings dem;
  FootShape shape;
  Eigen::AlignedBox3d region_m;
  double d50_m = 0;
};

struct FieldScene {
  /// How far below the foot's lowest point its surroundings are measured, in d50.
  static constexpr double kZone_d50 = 3;

  FieldScene(const FieldSetting& setting, const FieldMoment& moment);

  const FieldSetting& setting;
  const FieldMoment& moment;
  PlacedFoot foot;
  Footprint plan;
  double low_m;  // the foot's lowest point
  std::vector<ForceLine> lines;

  /// The zone under the foot: below its plan, from its lowest point kZone_d50 down.
  bool in_zone(const Eigen::Vector3d& p_m) const;
  double zone_bottom_m() const { return low_m - kZone_d50 * setting.d50_m; }
  /// Vertical force of the sand on the foot, summed over its contacts, N.
  double load_N() const;
  double mass_kg(const sim::Grain& g) const;
};

/// Place of a grain in a list by id, or -1.
std::ptrdiff_t find_grain(const std::vector<sim::Grain>& grains, std::uint32_t id);

}  // namespace hoof::tools
