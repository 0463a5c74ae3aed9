#include "tools/fields/stress_bulb.h"

#include <cmath>

namespace hoof::tools {

std::optional<double> bulb_depth_m(const std::vector<double>& share, double layer_m, double edge) {
  std::size_t last = share.size();  // the deepest layer that reaches the edge
  while (last > 0 && !(share[last - 1] >= edge)) --last;
  if (last == 0) return 0.0;
  if (last == share.size()) return {};
  const double above = share[last - 1], below = share[last];
  return layer_m * (double(last) - 0.5 + (above - edge) / (above - below));
}

StressBulb stress_bulb(const FieldScene& scene, const FieldScene& before) {
  StressBulb bulb;
  const double area_m2 = scene.plan.foot_area_m2(), gap_m2 = scene.plan.gap_area_m2();
  const double load_N = scene.load_N();
  if (!(area_m2 > 0) || !(load_N > 0)) return bulb;
  bulb.nominal_Pa = load_N / area_m2;
  double weight_N = 0;
  for (const sim::Grain& g : scene.moment.sand.grains) {
    if (scene.in_zone(g.p_m)) {
      weight_N += scene.mass_kg(g) * scene.setting.dem.gravity_m_s2.norm();
    }
  }
  if (load_N < StressBulb::kLeast_weights * weight_N) return bulb;
  bulb.layer_m = 0.5 * scene.setting.d50_m;
  const double floor_m = scene.setting.region_m.min().z();
  const int layers = std::max(0, int(std::floor((scene.low_m - floor_m) / bulb.layer_m)));
  const auto forces = [&](const FieldScene& s) {
    return layer_forces(s.lines, scene.plan, scene.low_m, bulb.layer_m, layers);
  };
  const LayerForces now = forces(scene), then = forces(before);
  for (std::size_t k = 0; k < std::size_t(layers); ++k) {
    bulb.share.push_back((now.foot_N[k] - then.foot_N[k]) / load_N);
    if (gap_m2 > 0) {
      bulb.gap_share.push_back((now.gap_N[k] - then.gap_N[k]) / gap_m2 / bulb.nominal_Pa);
    }
  }
  bulb.depth_m = bulb_depth_m(bulb.share, bulb.layer_m, StressBulb::kEdge);
  return bulb;
}

}  // namespace hoof::tools
