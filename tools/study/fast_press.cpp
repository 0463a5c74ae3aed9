#include "tools/study/fast_press.h"

#include <cmath>
#include <stdexcept>

#include "sim/effects/effect.h"
#include "sim/terrain/rft_terrain.h"

namespace hoof::tools {
namespace {

constexpr double kStep_m = 0.1e-3;
/// Before first contact.
constexpr double kGap_m = 0.1e-3;

}  // namespace

PressCurve press_fast_soil(const PressCase& c, const sim::RftTerrainSettings& soil,
                           const SoilEffectChoice& effect) {
  sim::RftTerrain terrain(soil);
  if (!effect.name.empty()) {
    const sim::EffectInfo* info = sim::find_effect(effect.name);
    if (info == nullptr || !info->make_soil) {
      throw std::invalid_argument("no effect of the soil: " + effect.name);
    }
    terrain.add_effect(info->make_soil(effect.values));
  }
  const double start_z_m = soil.surface_height_m + kGap_m - c.indenter.lowest_m();
  std::vector<sim::BodyMotion> motions;
  for (const Indenter::Part& part : c.indenter.parts) {
    sim::Pose pose;
    pose.p_WB_m = part.p_WB_m + Eigen::Vector3d(c.offset_x_m, 0, start_z_m);
    pose.q_WB = Eigen::AngleAxisd(part.yaw_rad, Eigen::Vector3d::UnitZ());
    terrain.add_body(part.mesh, pose);
    motions.push_back({pose, pose});
  }
  std::vector<sim::Wrench> wrenches(motions.size());
  PressCurve curve;
  double depth_m = soil.surface_height_m - start_z_m;
  for (int steps = int(std::lround((c.depth_m - depth_m) / kStep_m)); steps > 0; --steps) {
    for (sim::BodyMotion& motion : motions) {
      motion.start = motion.end;
      motion.end.p_WB_m.z() -= kStep_m;
    }
    terrain.advance(kStep_m / c.speed_m_s, motions, wrenches);
    depth_m += kStep_m;
    PressSample sample;
    sample.depth_m = depth_m;
    for (const sim::Wrench& wrench : wrenches) sample.force_N += wrench.f_W_N.z();
    curve.samples.push_back(sample);
  }
  return curve;
}

double solve_monotone(const std::function<double(double)>& f, double target, double low,
                      double high) {
  const bool rises = f(high) > f(low);
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    ((f(middle) < target) == rises ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace hoof::tools
