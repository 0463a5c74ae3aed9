// A plate on fast soil: bodies, settings and strokes that tests and their closed forms share.
#pragma once

#include "sim/terrain/rft_law.h"
#include "sim/terrain/rft_terrain.h"

namespace hoof::sim::test {

/// A closed box about its origin.
inline TriangleMesh box(const Eigen::Vector3d& size_m) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices_m.push_back(
        0.5 * size_m.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// One rectangle about its origin whose normal is -z: no sides that get in the way.
inline TriangleMesh sheet(double length_m, double width_m) {
  const double x = 0.5 * length_m, y = 0.5 * width_m;
  return {{{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, {{0, 2, 1}, {0, 3, 2}}};
}

inline RftTerrainSettings soil() {
  RftTerrainSettings s;
  s.name = "test";
  s.xi_n_N_m3 = {5e5, 0, "test"};
  s.bekker_k_phi_Pa = 2e5;
  s.bekker_k_c_N_m = 1e3;
  s.bekker_exponent = 0.7;
  s.bekker_width_m = 0.05;
  s.surface_friction = 0.6;
  s.yield_displacement_m = {0.5e-3, 0, "test"};
  s.damping_s = 1e-3;
  s.facet_size_m = 0.01;
  return s;
}

inline constexpr double kExchange_s = 50e-6;

/// A body that is moved about by hand.
class Stroke {
 public:
  Stroke(RftTerrain& terrain, const TriangleMesh& mesh, const Pose& start)
      : terrain_(terrain), pose_(start) {
    terrain.add_body(mesh, start);
  }

  Wrench to(const Pose& pose) {
    const BodyMotion motion{pose_, pose};
    pose_ = pose;
    Wrench wrench;
    terrain_.advance(kExchange_s, {&motion, 1}, {&wrench, 1});
    return wrench;
  }

  /// In steps of at most step_m along a straight line.
  Wrench by(const Eigen::Vector3d& way_m, double step_m = 5e-6) {
    const int n = std::max(1, int(std::ceil(way_m.norm() / step_m)));
    Wrench wrench;
    for (int i = 0; i < n; ++i) {
      Pose next = pose_;
      next.p_WB_m += way_m / n;
      wrench = to(next);
    }
    return wrench;
  }

  Wrench rest() { return to(pose_); }
  const Pose& pose() const { return pose_; }

 private:
  RftTerrain& terrain_;
  Pose pose_;
};

}  // namespace hoof::sim::test
