#include "tools/fields/arch_bridge.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/fields/max_flow.h"

namespace hoof::tools {
namespace {

std::vector<const ForceLine*> lines_where(
    const FieldScene& scene, const std::function<bool(const Eigen::Vector3d&)>& holds) {
  std::vector<const ForceLine*> found;
  for (const ForceLine& line : scene.lines) {
    if (line.j != ForceLine::kWall && holds(0.5 * (line.from_m + line.to_m))) {
      found.push_back(&line);
    }
  }
  return found;
}

ForceChains chains_of(const std::vector<const ForceLine*>& lines) {
  ForceChains c;
  double sum_N = 0, strong_N = 0;
  for (const ForceLine* line : lines) {
    ++c.contacts;
    sum_N += line->f_normal_N;
    c.largest_N = std::max(c.largest_N, line->f_normal_N);
  }
  if (c.contacts == 0) return c;
  c.mean_N = sum_N / c.contacts;
  for (const ForceLine* line : lines) {
    if (!(line->f_normal_N > c.mean_N)) continue;
    ++c.strong;
    strong_N += line->f_normal_N;
  }
  if (sum_N > 0) c.strong_share = strong_N / sum_N;
  return c;
}

bool crosses_gap(const FieldScene& scene, const ForceLine& line) {
  constexpr int kPieces = 16;
  for (int k = 0; k < kPieces; ++k) {
    const Eigen::Vector3d p = line.from_m + (k + 0.5) / kPieces * (line.to_m - line.from_m);
    if (scene.plan.at(p.x(), p.y()) == Footprint::kGap) return true;
  }
  return false;
}

/// What one end of a line is: under which body, in the gap, or elsewhere.
std::uint8_t place_of(const FieldScene& scene, const ForceLine& line, bool first) {
  if (!first && line.j == ForceLine::kFoot) return std::uint8_t(line.body);
  const std::int32_t grain = first ? line.i : line.j;
  const Eigen::Vector3d& p_m = scene.moment.sand.grains[std::size_t(grain)].p_m;
  return scene.plan.at(p_m.x(), p_m.y());
}

}  // namespace

ForceChains force_chains(const FieldScene& scene) {
  return chains_of(
      lines_where(scene, [&](const Eigen::Vector3d& p_m) { return scene.in_zone(p_m); }));
}

ArchBridge arch_bridge(const FieldScene& scene) {
  ArchBridge arch;
  arch.gap_area_m2 = scene.plan.gap_area_m2();
  if (arch.gap_area_m2 == 0) return arch;
  double top_m = -1e9;
  for (const sim::Pose& pose : scene.moment.poses) top_m = std::max(top_m, pose.p_WB_m.z());
  const auto lines = lines_where(scene, [&](const Eigen::Vector3d& p) {
    return p.z() <= top_m && p.z() >= scene.zone_bottom_m() &&
           scene.plan.at(p.x(), p.y()) != Footprint::kNone;
  });
  const double mean_N = chains_of(lines).mean_N;
  constexpr double kPerNewton = 1e6;  // whole micronewtons
  const int bodies = int(scene.moment.poses.size());
  const int grains = int(scene.moment.sand.grains.size());
  for (int a = 0; a < bodies; ++a) {
    for (int b = a + 1; b < bodies; ++b) {
      // Bodies are nodes, as are the grains of the gap.
      MaxFlow paths(grains + bodies), force(grains + bodies);
      for (const ForceLine* line : lines) {
        if (!(line->f_normal_N > mean_N)) continue;
        const std::uint8_t place[] = {place_of(scene, *line, true), place_of(scene, *line, false)};
        int node[2];
        bool used = true;
        for (int end = 0; end < 2; ++end) {
          const bool in_gap = place[end] == Footprint::kGap;
          used &= in_gap || place[end] == a || place[end] == b;
          node[end] = in_gap ? (end == 0 ? line->i : line->j) : grains + place[end];
        }
        if (!used || node[0] == node[1]) continue;
        const bool direct = node[0] >= grains && node[1] >= grains;
        if (direct && !crosses_gap(scene, *line)) continue;
        paths.add_edge(node[0], node[1], 1);
        force.add_edge(node[0], node[1], std::llround(kPerNewton * line->f_normal_N));
      }
      arch.paths += int(paths.between(grains + a, grains + b));
      arch.force_N += double(force.between(grains + a, grains + b)) / kPerNewton;
    }
  }
  return arch;
}

}  // namespace hoof::tools
