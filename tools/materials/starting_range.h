// Where to begin with the coefficients of a sand of which a bulk density and an angle of repose
// were measured: the whole set that gives that angle, not a point of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/design_of_experiments/valley.h"
#include "tools/materials/repose_surface.h"

namespace hoof::tools {

/// Of the bed of the paper's size (sim/dem/README.md, hoof bed).
inline constexpr double kSolidShare = 0.598;
/// Of quartz (Ji et al. 2026, material table).
inline constexpr double kQuartz_kg_m3 = 2650;

struct StartingRequest {
  double bulk_density_kg_m3 = 0;
  double repose_deg = 0;
  double tolerance_deg = 1;
  std::optional<double> d50_m;

  /// @throws std::invalid_argument naming the flag, its value and its bounds
  void validate() const;
  double grain_density_kg_m3() const { return bulk_density_kg_m3 / kSolidShare; }
};

struct StartingRange {
  Valley valley;  // factors e, mu_r, mu_s

  /// Of the valley: its middle along the factor that it is longest in, then towards either end.
  struct Member {
    std::vector<double> coded;
    double restitution = 0, rolling_friction = 0, static_friction = 0;
    double angle_deg = 0, half95_deg = 0;  // by the surface; half of the 95 % interval of the mean
  };
  std::vector<Member> members;  // empty where nothing in the box gives the angle
  bool covered = true;          // the angle lies within those of the runs
};

/// @param doubts that a second test would leave of each of the factors, natural units
StartingRange starting_range(const ReposeSurface& surface, const StartingRequest& request,
                             const std::vector<double>& doubts);

/// 5 % of the range of each factor: what hoof anova takes.
std::vector<double> usual_doubts(const ReposeSurface& surface);

}  // namespace hoof::tools
