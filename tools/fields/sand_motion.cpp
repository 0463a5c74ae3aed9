#include "tools/fields/sand_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "sim/dem/closest_point.h"

namespace hoof::tools {

double weighted_quantile(std::vector<std::pair<double, double>> value_weight, double share) {
  std::sort(value_weight.begin(), value_weight.end());
  double total = 0, sum = 0;
  for (const auto& [value, weight] : value_weight) total += weight;
  if (!(total > 0)) return 0;
  for (const auto& [value, weight] : value_weight) {
    sum += weight;
    if (sum >= share * total) return value;
  }
  return value_weight.back().first;
}

Spread spread(std::vector<double> values, const std::vector<double>& weights) {
  Spread s;
  if (values.empty()) return s;
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    s.mean += weights[i] * values[i], sum += weights[i];
  s.mean /= sum;
  std::sort(values.begin(), values.end());
  s.p99 = values[std::size_t(0.99 * double(values.size() - 1))];
  s.largest = values.back();
  return s;
}

double kinetic_J(const FieldScene& scene, const sim::Grain& g) {
  return 0.5 * scene.mass_kg(g) *
         (g.v_m_s.squaredNorm() + 0.4 * g.radius_m * g.radius_m * g.w_rad_s.squaredNorm());
}

KineticExtent kinetic_extent(const FieldScene& scene, double cell_m) {
  KineticExtent e;
  std::array<std::vector<std::pair<double, double>>, 3> along;
  std::map<std::array<int, 3>, double> cells;
  for (const sim::Grain& g : scene.moment.sand.grains) {
    const double energy_J = kinetic_J(scene, g);
    e.total_J += energy_J;
    std::array<int, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      along[axis].push_back({g.p_m[int(axis)], energy_J});
      cell[axis] = int(std::floor(g.p_m[int(axis)] / cell_m));
    }
    cells[cell] += energy_J;
  }
  if (!(e.total_J > 0)) return e;
  const double tail = (1 - KineticExtent::kShare) / 2;
  e.depth_m = -weighted_quantile(along[2], 1 - KineticExtent::kShare);
  e.length_m = weighted_quantile(along[0], 1 - tail) - weighted_quantile(along[0], tail);
  e.width_m = weighted_quantile(along[1], 1 - tail) - weighted_quantile(along[1], tail);
  std::vector<double> energies;
  for (const auto& [cell, energy_J] : cells) energies.push_back(energy_J);
  std::sort(energies.rbegin(), energies.rend());
  double sum = 0;
  for (const double energy_J : energies) {
    if (sum >= KineticExtent::kShare * e.total_J) break;
    sum += energy_J;
    e.volume_m3 += cell_m * cell_m * cell_m;
  }
  return e;
}

std::vector<Eigen::Vector3d> displacements_m(const FieldMoment& then, const FieldMoment& now) {
  std::vector<Eigen::Vector3d> ways(now.sand.grains.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const sim::Grain& g = now.sand.grains[i];
    const std::ptrdiff_t before = find_grain(then.sand.grains, g.id);
    if (before >= 0) ways[i] = g.p_m - then.sand.grains[std::size_t(before)].p_m;
  }
  return ways;
}

RearwardSpeed rearward_speed(const FieldScene& scene, FootPart part) {
  std::vector<sim::Facet> facets;
  Eigen::AlignedBox3d box;
  for (const FootTriangle& t : scene.foot.triangles) {
    if (t.part != part || t.area_m2 == 0) continue;
    facets.emplace_back(t.corners_m[0], t.corners_m[1], t.corners_m[2]);
    for (const Eigen::Vector3d& p : t.corners_m) box.extend(p);
  }
  RearwardSpeed rearward;
  double mass_kg = 0;
  for (const sim::Grain& g : scene.moment.sand.grains) {
    const double reach_m = g.radius_m + 0.5 * scene.setting.d50_m;
    if (facets.empty() || box.exteriorDistance(g.p_m) > reach_m) continue;
    const bool near = std::any_of(facets.begin(), facets.end(), [&](const sim::Facet& f) {
      return sim::closest_point(f, g.p_m).to_p_m.norm() <= reach_m;
    });
    if (!near) continue;
    const double m_kg = scene.mass_kg(g), speed_m_s = -g.v_m_s.x();
    if (rearward.grains++ == 0) rearward.largest_m_s = speed_m_s;
    mass_kg += m_kg;
    rearward.mean_m_s += m_kg * speed_m_s;
    rearward.largest_m_s = std::max(rearward.largest_m_s, speed_m_s);
  }
  if (mass_kg > 0) rearward.mean_m_s /= mass_kg;
  return rearward;
}

}  // namespace hoof::tools
