#include "sim/terrain/rigid_terrain.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace hoof::sim;
using Eigen::Vector3d;

namespace {

constexpr double kStep_s = 50e-6;

RigidTerrainSettings floor_at(double height_m) {
  RigidTerrainSettings s;
  s.surface_height_m = height_m;
  s.stiffness_N_m = 1e5;
  s.damping_N_s_m = 0.0;
  s.tangential_ratio = 0.5;
  s.friction = 0.6;
  return s;
}

/// One vertex: the body is a point, its mesh needs no triangles here.
TriangleMesh point(const Vector3d& p = Vector3d::Zero()) {
  return {{p}, {}};
}

Pose at(const Vector3d& p) {
  return {p, Eigen::Quaterniond::Identity()};
}

Wrench move(RigidTerrain& terrain, const Vector3d& from, const Vector3d& to) {
  const BodyMotion motion{at(from), at(to)};
  Wrench wrench;
  terrain.advance(kStep_s, {&motion, 1}, {&wrench, 1});
  return wrench;
}

}  // namespace

TEST_CASE("the floor pushes up by stiffness times depth, and never pulls") {
  RigidTerrain terrain(floor_at(0.5));
  terrain.add_body(point(), at({0, 0, 1}));
  CHECK(terrain.surface_height_m() == 0.5);
  CHECK(move(terrain, {0, 0, 1}, {0, 0, 0.5}).f_W_N.norm() == 0.0);
  CHECK((move(terrain, {0, 0, 0.5}, {0, 0, 0.499}).f_W_N - Vector3d(0, 0, 100)).norm() < 1e-9);

  RigidTerrainSettings damped = floor_at(0.0);
  damped.damping_N_s_m = 1e3;
  RigidTerrain sticky(damped);
  sticky.add_body(point(), at({0, 0, 0}));
  // 1 um up in 50 us is 0.02 m/s: 20 N of damping on 10 N of spring.
  CHECK((move(sticky, {0, 0, -1.01e-4}, {0, 0, -1e-4}).f_W_N - Vector3d(0, 0, 0)).norm() < 1e-12);
  CHECK(move(sticky, {0, 0, -1e-4}, {0, 0, -1.01e-4}).f_W_N.z() == Approx(10.1 + 20.0));
}

TEST_CASE("torque is about the body's origin") {
  RigidTerrain terrain(floor_at(0.0));
  terrain.add_body(point({0.1, -0.2, -1.0}), at({0, 0, 1}));
  const Wrench w = move(terrain, {5, 6, 0.999}, {5, 6, 0.999});
  CHECK((w.f_W_N - Vector3d(0, 0, 100)).norm() < 1e-9);
  CHECK((w.tau_Bo_W_Nm - Vector3d(0.1, -0.2, -1.0).cross(w.f_W_N)).norm() < 1e-9);
}

TEST_CASE("along the surface: a spring up to Coulomb's limit, against the motion") {
  RigidTerrain terrain(floor_at(0.0));
  terrain.add_body(point(), at({0, 0, 0}));
  const double sign = GENERATE(-1.0, 1.0);
  const double z = -1e-3;  // 100 N, friction limit 60 N
  move(terrain, {0, 0, z}, {0, 0, z});
  // 0.5 mm at 5e4 N/m: 25 N, sticking; back to the start it is gone.
  CHECK(move(terrain, {0, 0, z}, {sign * 5e-4, 0, z}).f_W_N.x() == Approx(-sign * 25.0));
  CHECK(move(terrain, {sign * 5e-4, 0, z}, {0, 0, z}).f_W_N.x() == Approx(0.0).margin(1e-9));
  // 5 mm would be 250 N: slides at 60 N in the direction it is dragged.
  const Wrench slide = move(terrain, {0, 0, z}, {sign * 3e-3, sign * 4e-3, z});
  CHECK(slide.f_W_N.x() == Approx(-sign * 36.0));
  CHECK(slide.f_W_N.y() == Approx(-sign * 48.0));
  // Turning back, the spring unloads from the limit: 60 N less 5e4 N/m * 1 mm.
  const Wrench back =
      move(terrain, {sign * 3e-3, sign * 4e-3, z}, {sign * 2.4e-3, sign * 3.2e-3, z});
  CHECK(back.f_W_N.head<2>().norm() == Approx(10.0));
  // Lifted off, the memory is gone.
  move(terrain, {0, 0, z}, {0, 0, 1e-3});
  CHECK(move(terrain, {0, 0, z}, {0, 0, z}).f_W_N.x() == 0.0);
}

TEST_CASE("on closed paths the floor gives no energy") {
  RigidTerrainSettings settings = floor_at(0.0);
  const bool damped = GENERATE(false, true);
  settings.damping_N_s_m = damped ? 50.0 : 0.0;
  RigidTerrain terrain(settings);
  terrain.add_body(point(), at({0, 0, 1e-3}));
  const unsigned seed = 7;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> way(-1e-3, 1e-3);
  const Vector3d home(0, 0, 1e-3);
  double work = 0.0;
  for (int loop = 0; loop < 50; ++loop) {
    Vector3d from = home;
    for (int i = 0; i < 20; ++i) {
      // Each leg of the path in 100 steps, so that the trapezoid of the work is fine enough.
      const Vector3d target = i < 19 ? Vector3d(way(random), way(random), way(random)) : home;
      const Vector3d start = from;
      for (int k = 1; k <= 100; ++k) {
        const Vector3d to = start + (target - start) * (k / 100.0);
        move(terrain, from, to);
        from = to;
      }
    }
    // Each loop ends above the floor: what it took it keeps. 1e-6 J: trapezoid, 0.1 J a loop.
    CHECK(terrain.work_on_bodies_J() < work + 1e-6);
    work = terrain.work_on_bodies_J();
  }
  CHECK(work < -0.01);
}
