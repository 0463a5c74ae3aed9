#include "sim/terrain/bed_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/terrain/bed_grading.h"

namespace hoof::sim {

BedReport inspect_bed(const BedSettings& bed, const Materials& materials, const BedState& state) {
  BedReport report;
  report.grains = state.grains.size();
  const double low = -0.9 * bed.depth_m, high = -0.1 * bed.depth_m;
  double in_layer_m3 = 0, all_m3 = 0;
  std::array<std::size_t, 12> regions{};
  for (const Grain& g : state.grains) {
    all_m3 += sphere_m3(2 * g.radius_m);
    // Part of a sphere below height h above its centre: pi/3 (r+h)^2 (2r-h), between -r and r.
    const auto below = [&](double z) {
      const double h = std::clamp(z - g.p_m.z(), -g.radius_m, g.radius_m);
      return std::numbers::pi / 3 * (g.radius_m + h) * (g.radius_m + h) * (2 * g.radius_m - h);
    };
    in_layer_m3 += below(high) - below(low);
    const int x = std::clamp(int((g.p_m.x() / bed.box_length_m + 0.5) * 4), 0, 3);
    const int y = std::clamp(int((g.p_m.y() / bed.box_width_m + 0.5) * 3), 0, 2);
    ++regions[std::size_t(y * 4 + x)];
  }
  report.solids_kg = all_m3 * materials.sand.density_kg_m3.value;
  report.solid_share = in_layer_m3 / (bed.box_length_m * bed.box_width_m * (high - low));
  for (const std::size_t n : regions) {
    report.largest_cell_deviation = std::max(
        report.largest_cell_deviation, std::abs(double(n) * 12 / double(state.grains.size()) - 1));
  }
  const SandBed sand(dem_settings(bed, materials, 1), state);
  report.coordination_number = 2.0 *
                               double(std::count_if(state.contacts.begin(), state.contacts.end(),
                                                    [](const GrainContact& c) {
                                                      return c.j < GrainContact::kWallContact;
                                                    })) /
                               double(state.grains.size());
  report.kinetic_energy_J = sand.kinetic_energy_J();
  return report;
}

}  // namespace hoof::sim
