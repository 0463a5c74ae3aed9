#include "sim/terrain/rft_terrain.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/sim/terrain/soil_plate.h"

using namespace hoof::sim;
using namespace hoof::sim::test;
using Eigen::Vector3d;

namespace {

Pose at(double x_m, double z_m) {
  return {{x_m, 0, z_m}, Eigen::Quaterniond::Identity()};
}

/// A mass on a sheet under a load, in the plant's order: force of before, then the ground.
struct Fall {
  double mass_kg = 1.5, load_N = 0, z_m = 0, v_m_s = 0, force_N = 0, deepest_m = 0;

  void step(Stroke& stroke) {
    v_m_s += kExchange_s * (force_N - load_N) / mass_kg;
    z_m += kExchange_s * v_m_s;
    force_N = stroke.to(at(0, z_m)).f_W_N.z();
    deepest_m = std::max(deepest_m, -z_m);
  }
};

constexpr double kArea_m2 = 0.1 * 0.05;

}  // namespace

TEST_CASE("a flat plate straight down meets scale times area times depth") {
  for (const PressureLaw law : {PressureLaw::kLinear, PressureLaw::kBekker}) {
    RftTerrainSettings s = soil();
    s.pressure_law = law;
    RftTerrain terrain(s);
    Stroke stroke(terrain, sheet(0.1, 0.05), at(0, 0.001));
    for (const double depth_m : {0.002, 0.01, 0.03}) {
      const Wrench w = stroke.by({0, 0, -depth_m - stroke.pose().p_WB_m.z()});
      const double expected_N = law == PressureLaw::kLinear
                                    ? 5e5 * kArea_m2 * depth_m * rft::flat_plate_alpha()
                                    : kArea_m2 * (1e3 / 0.05 + 2e5) * std::pow(depth_m, 0.7);
      CAPTURE(int(law), depth_m);
      CHECK(w.f_W_N.z() == Approx(expected_N));
      CHECK(w.f_W_N.head<2>().norm() < 1e-9 * expected_N);
      CHECK(w.tau_Bo_W_Nm.norm() < 1e-9 * expected_N);
    }
  }
}

TEST_CASE("nothing pulls: no force above the sand, none on the way up") {
  RftTerrain terrain(soil());
  Stroke stroke(terrain, sheet(0.1, 0.05), at(0, 0.02));
  CHECK(stroke.by({0.01, 0, -0.0199}).f_W_N.norm() == 0);
  const double pressed_N = stroke.by({0, 0, -0.0201}).f_W_N.z();
  CHECK(pressed_N > 50);
  // Within the yield displacement the load goes, in proportion.
  const double half_N = stroke.by({0, 0, 0.25e-3}, 1e-8).f_W_N.z();
  CHECK(half_N == Approx(0.5 * pressed_N).epsilon(0.05));  // 1.2 % of depth, and the damper
  CHECK(stroke.by({0, 0, 0.3e-3}).f_W_N.norm() == 0);
  CHECK(stroke.by({0, 0, 0.01}).f_W_N.norm() == 0);
}

TEST_CASE("horizontal force is against the motion in all four directions") {
  for (const Vector3d& way :
       {Vector3d(0.02, 0, 0), Vector3d(-0.02, 0, 0), Vector3d(0, 0.02, 0), Vector3d(0, -0.02, 0)}) {
    RftTerrain terrain(soil());
    Stroke stroke(terrain, box({0.05, 0.05, 0.02}), at(0, 0.011));
    stroke.by({0, 0, -0.026});
    const Vector3d f = stroke.by(way).f_W_N;
    CAPTURE(way.transpose(), f.transpose());
    CHECK(f.dot(way.normalized()) < -1);
    CHECK(std::abs(f.cross(way.normalized()).z()) < 1e-6);
  }
}

TEST_CASE("the force turns with the motion, and torque is about the body's origin") {
  RftTerrain one(soil()), other(soil());
  const Eigen::Quaterniond yaw(Eigen::AngleAxisd(0.7, Vector3d::UnitZ()));
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.3, Vector3d::UnitY()));
  Stroke straight(one, sheet(0.1, 0.05), {{0, 0, 0.03}, tilt});
  Stroke turned(other, sheet(0.1, 0.05), {{0, 0, 0.03}, yaw * tilt});
  const Wrench a = straight.by({0.01, 0.002, -0.04});
  const Wrench b = turned.by(yaw * Vector3d(0.01, 0.002, -0.04));
  CHECK(a.tau_Bo_W_Nm.norm() > 0.1);
  CHECK((b.f_W_N - yaw * a.f_W_N).norm() < 1e-9);
  CHECK((b.tau_Bo_W_Nm - yaw * a.tau_Bo_W_Nm).norm() < 1e-9);
  // An upward force ahead of the origin turns the body's front up: about -y.
  RftTerrain ahead(soil());
  TriangleMesh mesh = sheet(0.1, 0.05);
  for (Vector3d& vertex : mesh.vertices_m) vertex.x() += 0.2;
  const Wrench w = Stroke(ahead, mesh, at(0, 0)).by({0, 0, -0.01});
  CHECK(w.tau_Bo_W_Nm.y() == Approx(-0.2 * w.f_W_N.z()));
}

TEST_CASE("a standing load does not creep") {
  RftTerrain terrain(soil());
  Stroke stroke(terrain, sheet(0.1, 0.05), at(0, 0));
  Fall fall;
  fall.load_N = 40;
  for (int i = 0; i < 20000; ++i) fall.step(stroke);  // 1 s
  const double z_m = fall.z_m;
  CHECK(fall.force_N == Approx(40).epsilon(1e-9));
  for (int i = 0; i < 200000; ++i) fall.step(stroke);  // 10 s more
  CHECK(std::abs(fall.z_m - z_m) < 1e-9);
}

TEST_CASE("a mass comes to rest where the closed forms say") {
  const double k_N_m = 5e5 * kArea_m2 * rft::flat_plate_alpha();
  SECTION("let go at the surface it goes twice as deep as its weight needs") {
    RftTerrain terrain(soil());
    Stroke stroke(terrain, sheet(0.1, 0.05), at(0, 0));
    Fall fall;
    fall.load_N = 40;
    for (int i = 0; i < 40000; ++i) fall.step(stroke);
    // Less by the start: the damper fills the yield displacement at once, so that the law is the
    // linear one nearly from the first step.
    CHECK(fall.deepest_m == Approx(2 * 40 / k_N_m).epsilon(0.02));
    CHECK(std::abs(fall.v_m_s) < 1e-6);
    CHECK(fall.deepest_m - -fall.z_m < 0.5e-3);  // rebound within the yield displacement
  }
  SECTION("loaded slowly it stands where the sand just carries it") {
    RftTerrain terrain(soil());
    Stroke stroke(terrain, sheet(0.1, 0.05), at(0, 0));
    Fall fall;
    for (int i = 0; i < 200000; ++i) {
      fall.load_N = std::min(40.0, i * 40.0 / 160000);
      fall.step(stroke);
    }
    CHECK(-fall.z_m == Approx(40 / k_N_m).epsilon(0.01));
  }
}

TEST_CASE("a foot's mass on the sand is stable at the exchange interval and ends its ringing") {
  RftTerrainSettings s = soil();
  s.xi_n_N_m3.value = 5e6;  // ten times as stiff as the shipped soil
  RftTerrain terrain(s);
  Stroke stroke(terrain, sheet(0.175, 0.08), at(0, 0.001));
  Fall fall;
  fall.load_N = 600, fall.z_m = 0.001, fall.v_m_s = -0.4;
  for (int i = 0; i < 20000; ++i) fall.step(stroke);
  CHECK(fall.force_N == Approx(600).epsilon(1e-6));
  CHECK(std::abs(fall.v_m_s) < 1e-6);
}

TEST_CASE("no closed path gives energy") {
  // Random closed loops of a box in the sand, small ones within the yield displacement and large
  // ones, with and without the damper. Once what the first stroke stored is spent (half of 100 N
  // times 0.5 mm at most), the soil only takes.
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    RftTerrainSettings s = soil();
    if (seed % 2 == 0) s.damping_s = 0;
    s.facet_size_m = 0.03;
    const double size_m = seed % 3 == 0 ? 0.2e-3 : seed % 3 == 1 ? 1e-3 : 10e-3;
    RftTerrain terrain(s);
    Stroke stroke(terrain, box({0.1, 0.05, 0.02}), at(0, 0.011));
    stroke.by({0, 0, -0.031});
    const Vector3d home = stroke.pose().p_WB_m;
    std::vector<Vector3d> corners;
    for (int i = 0; i < 5; ++i) {
      corners.push_back(home + size_m * Vector3d(unit(random), unit(random), unit(random)));
    }
    corners.push_back(home);
    const auto loop = [&] {
      const double before_J = terrain.work_on_bodies_J();
      for (const Vector3d& corner : corners) {
        stroke.by(corner - stroke.pose().p_WB_m, size_m / 50);
      }
      return terrain.work_on_bodies_J() - before_J;
    };
    INFO("seed " << seed << ", size " << size_m << " m");
    double first_J = 0;
    // Within the yield displacement and without the damper the store lasts longest.
    const int loops = seed % 6 == 0 ? 100 : 3;
    for (int i = 0; i < loops; ++i) first_J += loop();
    CHECK(first_J < 0.5 * 100 * 0.5e-3);
    CHECK(loop() < 1e-12);  // rounding
    CHECK(terrain.work_on_bodies_J() < 0);
  }
}

TEST_CASE("circling within the yield displacement gives nothing in either sense") {
  for (const double sense : {1.0, -1.0}) {
    RftTerrainSettings s = soil();
    s.damping_s = 0;
    RftTerrain terrain(s);
    Stroke stroke(terrain, sheet(0.1, 0.05), at(0, 0));
    stroke.by({0, 0, -0.02});
    stroke.by({0, 0, 0.25e-3});
    const Vector3d centre = stroke.pose().p_WB_m;
    const auto turns = [&](int n) {
      const double before_J = terrain.work_on_bodies_J();
      for (int i = 1; i <= n * 500; ++i) {
        const double phase = sense * 2 * std::numbers::pi * i / 500;
        stroke.to({centre + 0.2e-3 * Vector3d(std::sin(phase), 0, std::cos(phase) - 1),
                   Eigen::Quaterniond::Identity()});
      }
      return terrain.work_on_bodies_J() - before_J;
    };
    turns(1);
    CAPTURE(sense);
    CHECK(turns(20) < 1e-9);
  }
}

TEST_CASE("the same path gives the same bits, and settings that cannot be are named") {
  const auto run = [] {
    RftTerrain terrain(soil());
    Stroke stroke(terrain, box({0.1, 0.05, 0.02}), at(0, 0.011));
    return stroke.by({0.003, 0.001, -0.02}).f_W_N;
  };
  CHECK(run() == run());
  RftTerrainSettings s = soil();
  CHECK(s.hash() == soil().hash());
  s.name = "other";
  CHECK(s.hash() == soil().hash());  // names carry no load
  s.surface_friction = 0.61;
  CHECK(s.hash() != soil().hash());
  s.yield_displacement_m.value = 0;
  CHECK_THROWS_WITH(RftTerrain(s), "yield_displacement_m = 0: must be above 0");
  s = soil();
  s.pressure_law = PressureLaw::kBekker;
  s.bekker_k_c_N_m = -1e5;
  CHECK_THROWS_WITH(
      RftTerrain(s),
      "bekker_k_c_N_m / bekker_width_m + bekker_k_phi_Pa = -1.8e+06: must be above 0");
}

TEST_CASE("the shipped soils are read, and a slip in one is named with its place") {
  Settings run;
  run.merge(Settings::load_file(default_config_dir() / "rft_terrain/demo.toml"), "rft_terrain");
  const RftTerrainSettings shipped = read_rft_terrain(Reader(run).section("rft_terrain"));
  CHECK(shipped.xi_n_N_m3.value > 1e4);
  CHECK(shipped.fit_error > 0);
  CHECK(shipped.fit_error < 1);
  CHECK_FALSE(shipped.fitted_to.empty());
  run.set("rft_terrain.surface_friction=9");
  CHECK_THROWS_WITH(read_rft_terrain(Reader(run).section("rft_terrain")),
                    Catch::Contains("surface_friction = 9"));
}
