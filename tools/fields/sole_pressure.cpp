#include "tools/fields/sole_pressure.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace hoof::tools {

std::vector<double> triangle_pressure_Pa(const FieldScene& scene) {
  std::vector<double> pressure_Pa(scene.foot.triangles.size());
  for (const sim::MeshTouch& t : scene.moment.touches) {
    const std::size_t k = scene.foot.first_triangle[t.mesh] + t.triangle;
    const double f_N = t.f_normal_N.dot(t.to_grain_m.normalized());
    pressure_Pa[k] += f_N / scene.foot.triangles[k].area_m2;
  }
  return pressure_Pa;
}

double share_above(const FieldScene& scene, const std::vector<double>& pressure_Pa, double p_Pa) {
  double all_m2 = 0, above_m2 = 0;
  for (std::size_t k = 0; k < pressure_Pa.size(); ++k) {
    const FootTriangle& t = scene.foot.triangles[k];
    if (!t.plantar()) continue;
    all_m2 += t.area_m2;
    if (pressure_Pa[k] > p_Pa) above_m2 += t.area_m2;
  }
  return all_m2 > 0 ? above_m2 / all_m2 : 0;
}

double pressure_of_share_Pa(const FieldScene& scene, const std::vector<double>& pressure_Pa,
                            double share) {
  std::vector<double> levels = {0};
  for (std::size_t k = 0; k < pressure_Pa.size(); ++k) {
    if (scene.foot.triangles[k].plantar()) levels.push_back(std::max(0.0, pressure_Pa[k]));
  }
  std::sort(levels.begin(), levels.end());
  for (const double p_Pa : levels) {
    if (share_above(scene, pressure_Pa, p_Pa) < share) return p_Pa;
  }
  return levels.back();
}

SolePressure sole_pressure(const FieldScene& scene) {
  SolePressure s;
  const std::vector<double> pressure_Pa = triangle_pressure_Pa(scene);
  double spines_N = 0;
  for (const sim::MeshTouch& t : scene.moment.touches) {
    const FootTriangle& triangle = scene.foot.triangle(t.mesh, t.triangle);
    if (triangle.part == FootPart::kSpine) spines_N -= (t.f_normal_N + t.f_tangential_N).z();
    if (!triangle.plantar()) continue;
    s.normal_force_N += t.f_normal_N.dot(t.to_grain_m.normalized());
    const double radius_m = t.to_grain_m.norm() + t.overlap_m;
    s.hertz_area_m2 += std::numbers::pi * radius_m * t.overlap_m;
  }
  for (std::size_t k = 0; k < pressure_Pa.size(); ++k) {
    const FootTriangle& t = scene.foot.triangles[k];
    if (!t.plantar()) continue;
    s.plantar_area_m2 += t.area_m2;
    if (pressure_Pa[k] != 0) s.touched_area_m2 += t.area_m2;
    s.peak_Pa = std::max(s.peak_Pa, pressure_Pa[k]);
  }
  const double load_N = scene.load_N();
  if (scene.plan.foot_area_m2() > 0) s.threshold_Pa = load_N / scene.plan.foot_area_m2();
  s.high_share = share_above(scene, pressure_Pa, std::max(0.0, s.threshold_Pa));
  s.spine_load_share = load_N != 0 ? spines_N / load_N : std::numeric_limits<double>::quiet_NaN();
  return s;
}

}  // namespace hoof::tools
