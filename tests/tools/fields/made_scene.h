// Moments put together by hand: grains at known places, contacts and feet of boxes.
#pragma once

#include <Eigen/Geometry>

#include "sim/terrain/bed_contacts.h"
#include "tests/sim/terrain/small_bed.h"
#include "tools/fields/field_scene.h"

namespace hoof::tests {

inline sim::DemSettings made_dem() {
  return sim::dem_settings(sim::test::small_bed(), sim::test::shipped_materials(), 1);
}

/// A closed box, outward normals, two triangles a side: 0, 1 the bottom; 2, 3 the top.
inline sim::TriangleMesh box_mesh(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m) {
  sim::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices_m.emplace_back(i & 1 ? high_m.x() : low_m.x(), i & 2 ? high_m.y() : low_m.y(),
                                 i & 4 ? high_m.z() : low_m.z());
  }
  const std::array<std::array<std::int32_t, 4>, 6> sides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& s : sides) {
    mesh.triangles.push_back({s[0], s[1], s[2]});
    mesh.triangles.push_back({s[0], s[2], s[3]});
  }
  return mesh;
}

/// A foot of boxes where they stand, and the sand that is asked for.
struct Made {
  tools::FieldSetting setting;
  tools::FieldMoment moment;

  explicit Made(std::vector<sim::TriangleMesh> boxes, bool has_spines = false) {
    setting.dem = made_dem();
    setting.d50_m = 4e-3;
    setting.region_m = {Eigen::Vector3d(-0.1, -0.1, -0.03), Eigen::Vector3d(0.1, 0.1, 0.1)};
    moment.poses.resize(boxes.size());
    setting.shape = tools::FootShape::of(std::move(boxes), has_spines);
  }

  /// @return its id: their number so far
  std::uint32_t grain(const Eigen::Vector3d& p_m, double radius_m = 2e-3,
                      const Eigen::Vector3d& v_m_s = Eigen::Vector3d::Zero()) {
    const auto id = std::uint32_t(moment.sand.grains.size());
    moment.sand.grains.push_back({id, radius_m, p_m, v_m_s, Eigen::Vector3d::Zero()});
    return id;
  }
  void contact(std::uint32_t i, std::uint32_t j) {
    moment.sand.contacts.push_back({i, j, Eigen::Vector3d::Zero()});
  }
  /// All pairs that overlap.
  void touch_all() {
    const auto& g = moment.sand.grains;
    for (std::uint32_t i = 0; i < g.size(); ++i) {
      for (std::uint32_t j = i + 1; j < g.size(); ++j) {
        if ((g[i].p_m - g[j].p_m).norm() < g[i].radius_m + g[j].radius_m) contact(i, j);
      }
    }
  }
  /// The foot presses on a grain with f_N along the normal from `spot` to its centre.
  void press(std::uint32_t grain, std::uint32_t body, std::uint32_t triangle,
             const Eigen::Vector3d& spot_m, double f_N) {
    const sim::Grain& g = moment.sand.grains[grain];
    const Eigen::Vector3d to_grain_m = g.p_m - spot_m;
    moment.touches.push_back({grain, body, triangle, g.radius_m - to_grain_m.norm(), spot_m,
                              to_grain_m, f_N * to_grain_m.normalized(), Eigen::Vector3d::Zero()});
  }
};

/// 4/3 E* sqrt(R*) delta^(3/2), Hertz 1882, two equal grains; E* = E / (2 (1 - nu^2)).
inline double hertz_N(double radius_m, double overlap_m) {
  const double E_eff_Pa = 178.5e6 / (2 * (1 - 0.25 * 0.25));
  return 4.0 / 3 * E_eff_Pa * std::sqrt(0.5 * radius_m) * std::pow(overlap_m, 1.5);
}

}  // namespace hoof::tests
