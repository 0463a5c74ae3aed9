#include "tools/fields/sand_packing.h"

#include <numbers>

namespace hoof::tools {
namespace {

/// Points of a unit ball.
std::vector<Eigen::Vector3d> ball() {
  constexpr int kAcross = 8;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      for (int k = 0; k < kAcross; ++k) {
        const Eigen::Vector3d p =
            (Eigen::Vector3d(i, j, k) * 2 + Eigen::Vector3d::Constant(1 - kAcross)) / kAcross;
        if (p.squaredNorm() < 1) points.push_back(p);
      }
    }
  }
  return points;
}

}  // namespace

Coordination coordination(const FieldScene& scene,
                          const std::function<bool(const Eigen::Vector3d&)>& holds) {
  const std::vector<sim::Grain>& grains = scene.moment.sand.grains;
  std::vector<int> partners(grains.size());
  std::vector<bool> on_foot(grains.size());
  for (const ForceLine& line : scene.lines) {
    const auto i = std::size_t(line.i);
    if (line.j == ForceLine::kFoot) {
      if (on_foot[i]) continue;  // several spots of one foot are one partner
      on_foot[i] = true;
    }
    ++partners[i];
    if (line.j >= 0) ++partners[std::size_t(line.j)];
  }
  Coordination c;
  double sum = 0, carrying = 0, partners_of_carrying = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (!holds(grains[i].p_m)) continue;
    ++c.grains;
    sum += partners[i];
    if (partners[i] < 2) continue;
    carrying += 1, partners_of_carrying += partners[i];
  }
  if (c.grains > 0) c.mean = sum / c.grains;
  if (carrying > 0) c.mechanical = partners_of_carrying / carrying;
  return c;
}

double solid_volume_m3(const std::vector<sim::Grain>& grains,
                       const std::function<bool(const Eigen::Vector3d&)>& holds) {
  static const std::vector<Eigen::Vector3d> kBall = ball();
  double volume_m3 = 0;
  for (const sim::Grain& g : grains) {
    int inside = 0;
    for (const Eigen::Vector3d& p : kBall) inside += holds(g.p_m + g.radius_m * p);
    volume_m3 += double(inside) / double(kBall.size()) * 4 / 3 * std::numbers::pi * g.radius_m *
                 g.radius_m * g.radius_m;
  }
  return volume_m3;
}

}  // namespace hoof::tools
