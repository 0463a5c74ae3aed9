#include "sim/rigs/plate_press.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace hoof::sim {
namespace {

/// Force with the plate at `depth_m`, while the deepest so far was contact.deepest_m.
double force_at_N(SoilContact contact, double depth_m, SoilEffects effects) {
  contact.depth_m = depth_m;
  contact.depth_m += extra_depth_m(contact, effects);
  contact.deepest_m = std::max(contact.deepest_m, contact.depth_m);
  return soil_force_N(contact, effects);
}

/// The depth that is left of `shown_m` when the rig travels under the force at that depth: root of
///   depth + travel(force(depth)) = shown,
/// whose left side grows with depth. False position with the Illinois rule (Dowell, Jarratt: BIT 11
/// (1971) 168), which keeps the root between its two ends.
double depth_under_load_m(const SoilContact& contact, double shown_m, SoilEffects effects) {
  const auto excess_m = [&](double depth_m) {
    return depth_m + rig_travel_m(force_at_N(contact, depth_m, effects), effects) - shown_m;
  };
  double high_m = shown_m;
  double high_excess_m = excess_m(high_m);
  if (!(high_excess_m > 0)) return shown_m;
  // Where an effect pushes even above the surface, the root may lie there.
  double low_m = std::min(0.0, shown_m);
  double low_excess_m = excess_m(low_m);
  if (low_excess_m >= 0) return low_m;
  const double tolerance_m = 1e-15 + 1e-14 * std::abs(shown_m);
  double depth_m = low_m;
  int kept = 0;  // which end was kept last: -1 the low one, 1 the high one
  for (int i = 0; i < 100 && high_m - low_m > tolerance_m; ++i) {
    depth_m = (low_m * high_excess_m - high_m * low_excess_m) / (high_excess_m - low_excess_m);
    if (!(depth_m > low_m && depth_m < high_m)) depth_m = std::midpoint(low_m, high_m);
    const double excess = excess_m(depth_m);
    if (std::abs(excess) <= tolerance_m) break;
    if (excess > 0) {
      high_m = depth_m;
      high_excess_m = excess;
      if (kept == -1) low_excess_m /= 2;
      kept = -1;
    } else {
      low_m = depth_m;
      low_excess_m = excess;
      if (kept == 1) high_excess_m /= 2;
      kept = 1;
    }
  }
  return depth_m;
}

}  // namespace

PlateSize disc(double diameter_m) {
  const double radius_m = diameter_m / 2;
  return {.area_m2 = std::numbers::pi * radius_m * radius_m, .width_m = radius_m};
}

PlateSize rectangle(double width_m, double length_m) {
  return {.area_m2 = width_m * length_m, .width_m = std::min(width_m, length_m)};
}

double plate_stiffness(const PlateSize& plate, const BekkerSoil& soil) {
  return plate.area_m2 * std::max(soil.k_c / plate.width_m + soil.k_phi, 0.0);
}

std::vector<double> press_sand_N(const PressBench& bench, const PressPath& path,
                                 SoilEffects effects) {
  SoilContact contact = {.area_m2 = bench.plate.area_m2,
                         .width_m = bench.plate.width_m,
                         .wall_distance_m = bench.wall_distance_m,
                         .stiffness_N_m = plate_stiffness(bench.plate, bench.soil),
                         .exponent = bench.soil.n};
  for (const auto& effect : effects) effect->reset();
  std::vector<double> forces_N(path.height_m.size());
  for (std::size_t i = 0; i < forces_N.size(); ++i) {
    contact.time_s = path.time_s[i];
    contact.speed_m_s = path.speed_m_s[i];
    contact.press = path.press[i];
    const double shown_m = bench.surface_height_m - path.height_m[i];
    const double depth_m = depth_under_load_m(contact, shown_m, effects);
    double force_N = force_at_N(contact, depth_m, effects);
    contact.depth_m = depth_m;
    contact.depth_m += extra_depth_m(contact, effects);
    // A plate that left the sand begins anew.
    contact.deepest_m = contact.depth_m > 0 ? std::max(contact.deepest_m, contact.depth_m) : 0.0;
    for (const auto& effect : effects) force_N = effect->measured_N(force_N, contact);
    forces_N[i] = force_N;
  }
  return forces_N;
}

std::vector<double> press_block_m(double contact_height_m, std::span<const double> force_N,
                                  SoilEffects effects) {
  std::vector<double> heights_m;
  heights_m.reserve(force_N.size());
  for (const double force : force_N) {
    heights_m.push_back(contact_height_m - rig_travel_m(std::max(force, 0.0), effects));
  }
  return heights_m;
}

}  // namespace hoof::sim
