#include "sim/terrain/bed_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/terrain/bed_contacts.h"
#include "sim/terrain/bed_grading.h"

namespace hoof::sim {
namespace {

/// Volume of the part of a grain that lies below the height z_m, m^3: a spherical cap of the height
/// r + h holds pi/3 (r + h)^2 (2 r - h).
double volume_below_m3(const Grain& g, double z_m) {
  const double r = g.radius_m;
  const double h = std::clamp(z_m - g.p_m.z(), -r, r);
  return std::numbers::pi / 3 * (r + h) * (r + h) * (2 * r - h);
}

void count_volumes(const BedSettings& bed, const BedState& state, BedReport& report) {
  const double area_m2 = bed.box_length_m * bed.box_width_m;
  const auto share_between = [&](double low_m, double high_m) {
    double solids_m3 = 0;
    for (const Grain& g : state.grains) {
      if (g.p_m.z() + g.radius_m < low_m || g.p_m.z() - g.radius_m > high_m) continue;
      solids_m3 += volume_below_m3(g, high_m) - volume_below_m3(g, low_m);
    }
    return solids_m3 / (area_m2 * (high_m - low_m));
  };
  report.solid_share = share_between(-0.9 * bed.depth_m, -0.1 * bed.depth_m);
  const double layer_m = bed.depth_m / BedReport::kLayers;
  for (int i = 0; i < BedReport::kLayers; ++i) {
    report.layer_solid_share[std::size_t(i)] =
        share_between(-bed.depth_m + i * layer_m, -bed.depth_m + (i + 1) * layer_m);
  }
}

void count_regions(const BedSettings& bed, const BedState& state, BedReport& report) {
  const auto cell = [](double x_m, double length_m, int n) {
    return std::clamp(int((x_m / length_m + 0.5) * n), 0, n - 1);
  };
  for (const Grain& g : state.grains) {
    const int x = cell(g.p_m.x(), bed.box_length_m, BedReport::kRegionsX);
    const int y = cell(g.p_m.y(), bed.box_width_m, BedReport::kRegionsY);
    ++report.region_grains[std::size_t(y * BedReport::kRegionsX + x)];
  }
  const double mean = double(state.grains.size()) / double(report.region_grains.size());
  for (const std::size_t n : report.region_grains) {
    report.largest_region_deviation =
        std::max(report.largest_region_deviation, std::abs(double(n) / mean - 1));
  }
}

void sum_energies(const Materials& materials, const BedState& state, BedReport& report) {
  const double density_kg_m3 = materials.sand.density_kg_m3.value;
  double lift_J = 0;
  for (const Grain& g : state.grains) {
    const double mass_kg = density_kg_m3 * sphere_m3(2 * g.radius_m);
    report.solids_kg += mass_kg;
    report.kinetic_energy_J +=
        0.5 * mass_kg *
        (g.v_m_s.squaredNorm() + 0.4 * g.radius_m * g.radius_m * g.w_rad_s.squaredNorm());
    lift_J += mass_kg * 9.81 * 2 * g.radius_m;
  }
  report.energy_ratio = report.kinetic_energy_J / lift_J;
}

}  // namespace

BedReport inspect_bed(const BedSettings& bed, const Materials& materials, const BedState& state) {
  BedReport report;
  report.grains = state.grains.size();
  count_volumes(bed, state, report);
  count_regions(bed, state, report);
  sum_energies(materials, state, report);
  report.graded_share = graded_shares(bed, state.grains);
  report.highest_grain_m = -std::numeric_limits<double>::infinity();
  for (const Grain& g : state.grains) {
    report.highest_grain_m = std::max(report.highest_grain_m, g.p_m.z() + g.radius_m);
  }
  std::size_t pairs = 0;
  for (const LoadedContact& c : loaded_contacts(dem_settings(bed, materials, 1), state)) {
    report.largest_overlap_ratio = std::max(report.largest_overlap_ratio, c.overlap_ratio);
    if (c.j < GrainContact::kWallContact) ++pairs;
  }
  report.coordination_number = 2.0 * double(pairs) / double(state.grains.size());
  return report;
}

}  // namespace hoof::sim
