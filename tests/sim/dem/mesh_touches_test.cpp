// What can be read off a bed without changing it: touches on meshes, the grains of a region.

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/dem/sand_bed.h"
#include "tests/sim/dem/boundary_rig.h"
#include "tests/sim/dem/falling_heap.h"
#include "tests/sim/dem/test_meshes.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

// 0.17 ms: the lowest layer meets the sheet after 0.07 ms and is held for 0.12 ms (Hertz), the next
// one presses on it.
constexpr int kSteps = 60;

/// A pile of grains falling onto a sheet at z = 0 (side 1), or rising into one above (side -1).
SandBed bed_on_sheet(int threads, double side, Precision precision, int steps) {
  DemSettings s = paper_settings();
  s.threads = threads;
  s.precision = precision;
  s.gravity_m_s2 = {0, 0, -9.81 * side};
  s.walls.clear();
  BedState state;
  std::uint32_t id = 0;
  for (int k = 0; k < 4; ++k) {
    for (int i = -2; i <= 2; ++i) {
      for (int j = -2; j <= 2; ++j) {
        state.grains.push_back(
            {id++,
             1.5e-3,
             {3.05e-3 * i + 1e-4 * k, 3.05e-3 * j, side * (1.52e-3 + 3.02e-3 * k)},
             {0.02 * j, -0.01 * i, -0.3 * side},
             {0, 0, 0}});
      }
    }
  }
  SandBed bed(s, state);
  bed.add_mesh(sheet_mesh(0.02, 7, [](double, double) { return 0.0; }), {0, 0, 0},
               Eigen::Quaterniond::Identity());
  bed.advance(steps);
  return bed;
}

}  // namespace

TEST_CASE("the touches of a moment are the force that the next step finds, on either side") {
  const double side = GENERATE(1.0, -1.0);
  const Precision precision = GENERATE(Precision::kMixed, Precision::kDouble);
  SandBed bed = bed_on_sheet(1, side, precision, kSteps);
  const std::uint64_t before = bed.state_hash();
  const std::string snapshot = bed.snapshot();
  const std::vector<MeshTouch> touches = bed.mesh_touches();
  CHECK(bed.state_hash() == before);
  CHECK(bed.snapshot() == snapshot);
  REQUIRE(touches.size() > 10);
  Eigen::Vector3d normal_N(0, 0, 0), sum_N(0, 0, 0);
  for (const MeshTouch& t : touches) {
    CHECK(t.mesh == 0);
    CHECK(std::abs(t.p_W_m.z()) < 1e-12);  // on the sheet
    CHECK(t.to_grain_m.z() * side > 0);
    CHECK(t.overlap_m > 0);
    // Triangles 2 c and 2 c + 1 are of cell c, whose corner and size are known.
    const int cell = int(t.triangle) / 2;
    const double size_m = 0.04 / 7;
    CHECK(std::abs(t.p_W_m.x() - (-0.02 + (cell / 7 + 0.5) * size_m)) <= 0.5 * size_m + 1e-9);
    CHECK(std::abs(t.p_W_m.y() - (-0.02 + (cell % 7 + 0.5) * size_m)) <= 0.5 * size_m + 1e-9);
    normal_N -= t.f_normal_N;
    sum_N -= t.f_normal_N + t.f_tangential_N;
  }
  for (std::size_t i = 1; i < touches.size(); ++i) CHECK(touches[i - 1].grain <= touches[i].grain);
  bed.take_load(0);
  bed.advance(1);
  const Eigen::Vector3d felt_N = bed.take_load(0).impulse_W_Ns / bed.settings().dt_s;
  CHECK(normal_N.z() * side < 0);
  // The normal force is that of this place and speed in both; along the sheet the springs have
  // moved on by a step.
  CHECK(sum_N.z() == Approx(felt_N.z()).epsilon(1e-9));
  CHECK((sum_N - felt_N).head<2>().norm() < 0.02 * felt_N.norm());
}

TEST_CASE("touches are the same from any number of threads") {
  SandBed one = bed_on_sheet(1, 1, Precision::kMixed, kSteps);
  SandBed three = bed_on_sheet(3, 1, Precision::kMixed, kSteps);
  const auto a = one.mesh_touches(), b = three.mesh_touches();
  REQUIRE(a.size() == b.size());
  REQUIRE_FALSE(a.empty());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].grain == b[i].grain);
    CHECK(a[i].triangle == b[i].triangle);
    CHECK(a[i].f_normal_N == b[i].f_normal_N);
    CHECK(a[i].f_tangential_N == b[i].f_tangential_N);
  }
}

TEST_CASE("a region holds its grains and the contacts among them, and nothing else") {
  SandBed bed = bed_on_sheet(1, 1, Precision::kMixed, kSteps);
  const BedState all = bed.state();
  const Eigen::AlignedBox3d region(Eigen::Vector3d(-0.004, -1, -1), Eigen::Vector3d(1, 1, 0.008));
  const BedState part = bed.state(region);
  std::vector<std::uint32_t> ids;
  for (const Grain& g : all.grains) {
    if (region.contains(g.p_m)) ids.push_back(g.id);
  }
  REQUIRE(part.grains.size() == ids.size());
  REQUIRE(ids.size() < all.grains.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    CHECK(part.grains[i].id == ids[i]);
    CHECK(part.grains[i].p_m == all.grains[ids[i]].p_m);
  }
  const auto inside = [&](std::uint32_t id) {
    return std::binary_search(ids.begin(), ids.end(), id);
  };
  std::vector<GrainContact> among;
  for (const GrainContact& c : all.contacts) {
    if (inside(c.i) && inside(c.j)) among.push_back(c);
  }
  REQUIRE_FALSE(among.empty());
  REQUIRE(among.size() < all.contacts.size());
  REQUIRE(part.contacts.size() == among.size());
  for (std::size_t i = 0; i < among.size(); ++i) {
    CHECK(part.contacts[i].i == among[i].i);
    CHECK(part.contacts[i].j == among[i].j);
    CHECK(part.contacts[i].xi_m == among[i].xi_m);
  }
}
