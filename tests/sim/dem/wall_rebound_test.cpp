// A meshed wall is a wall: the same rebound as from the analytic one, wherever it is hit.
#include <catch2/catch.hpp>
#include <vector>

#include "tests/sim/dem/paper_bed.h"
#include "tests/sim/dem/test_meshes.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

constexpr double kRadius_m = 2e-3;

struct Shot {
  const char* what;
  Eigen::Vector3d v_m_s, w_rad_s;
};
const std::vector<Shot> kShots = {
    {"head-on", {0, 0, -0.4}, {0, 0, 0}},
    {"oblique, sticking", {0.05, 0.02, -0.4}, {0, 0, 0}},
    {"oblique, sliding", {0.9, -0.3, -0.3}, {0, 0, 0}},
    {"with back spin", {0.3, 0, -0.3}, {0, -200, 0}},
    {"with spin about the normal", {0.1, 0.1, -0.3}, {20, 30, 300}},
};

/// The floor as a closed block, cut finer with every refinement, its top at z = 0.
TriangleMesh floor_mesh(int refinements) {
  TriangleMesh mesh = box_mesh({0.02, 0.02, 0.01});
  for (Eigen::Vector3d& v : mesh.vertices_m) v.z() -= 0.01;
  for (int i = 0; i < refinements; ++i) mesh = refined(mesh);
  return mesh;
}

Grain shoot(DemSettings s, const Shot& shot, const Eigen::Vector3d& foot_m,
            const TriangleMesh* mesh, const Eigen::Vector3d& p_WB_m = Eigen::Vector3d::Zero()) {
  if (mesh == nullptr) s.walls.push_back({Eigen::Vector3d::UnitZ(), 0});
  BedState start;
  start.grains = {grain_at(0, 2 * kRadius_m, foot_m + Eigen::Vector3d(0, 0, kRadius_m + 1e-6),
                           shot.v_m_s, shot.w_rad_s)};
  SandBed bed(s, start);
  if (mesh != nullptr) bed.add_mesh(*mesh, p_WB_m, Eigen::Quaterniond::Identity());
  bed.advance(400);
  return bed.state().grains[0];
}

void check_same(const Grain& wall, const Grain& mesh, const Shot& shot, double bound) {
  INFO(shot.what);
  CHECK(wall.v_m_s.z() > 0.1);  // it did rebound
  CHECK((wall.v_m_s - mesh.v_m_s).norm() <= bound * wall.v_m_s.norm());
  CHECK((wall.w_rad_s - mesh.w_rad_s).norm() <= bound * (1 + wall.w_rad_s.norm()));
}

}  // namespace

TEST_CASE("analytic and meshed walls give the same rebound: face, seam, vertex, any box") {
  // Both see the same numbers but for the last bit of a position (4e-18 m of an overlap of 1e-5 m).
  constexpr double kDouble = 1e-12;
  const std::vector<std::pair<const char*, Eigen::Vector3d>> feet = {
      {"face", {3.1e-3, 1.7e-3, 0}},
      {"diagonal seam", {0, 0, 0}},
      {"vertex", {5e-3, 5e-3, 0}},
      {"edge between squares", {5e-3, 1.3e-3, 0}},
      {"beside a seam", {1e-7, 0, 0}}};
  for (const bool periodic : {false, true}) {
    DemSettings s = paper_settings();
    s.precision = Precision::kDouble;
    s.periodic = {periodic, periodic, false};
    for (const int refinements : {0, 3}) {
      const TriangleMesh mesh = floor_mesh(refinements);
      for (const auto& [where, foot_m] : feet) {
        INFO(where << (periodic ? ", periodic, " : ", walled, ") << refinements << " refinements");
        for (const Shot& shot : kShots) {
          check_same(shoot(s, shot, foot_m, nullptr), shoot(s, shot, foot_m, &mesh), shot, kDouble);
        }
      }
    }
  }
}

TEST_CASE("a meshed wall acts across a periodic side, and where its body is a period away") {
  DemSettings s = paper_settings(0.015);  // narrower than the block: it overlaps its own image
  s.low_m.z() = -0.05, s.high_m.z() = 0.05;
  s.precision = Precision::kDouble;
  s.periodic = {true, true, false};
  TriangleMesh mesh = box_mesh({0.015, 0.015, 0.01});
  for (Eigen::Vector3d& v : mesh.vertices_m) v.z() -= 0.01;
  // Positions are rounded differently a period away: 4e-18 m of some 1e-5 m, once more per period.
  for (const Eigen::Vector3d& p_WB_m :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.03, -0.06, 0), Eigen::Vector3d(7e-3, 0, 0)}) {
    for (const Eigen::Vector3d& foot_m :
         {Eigen::Vector3d(0.0149, 0, 0), Eigen::Vector3d(-0.015, 0.01499, 0)}) {
      for (const Shot& shot : kShots) {
        INFO(p_WB_m.transpose() << " m; grain at " << foot_m.transpose() << " m");
        check_same(shoot(s, shot, foot_m, nullptr), shoot(s, shot, foot_m, &mesh, p_WB_m), shot,
                   1e-11);
      }
    }
  }
}

TEST_CASE("in mixed precision the two walls still agree as far as single precision goes") {
  const DemSettings s = paper_settings();
  const TriangleMesh mesh = floor_mesh(2);
  for (const Shot& shot : kShots) {
    check_same(shoot(s, shot, {1e-3, 2e-3, 0}, nullptr), shoot(s, shot, {1e-3, 2e-3, 0}, &mesh),
               shot, 1e-6);
  }
}
