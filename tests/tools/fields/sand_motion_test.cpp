// Speeds, energies, ways and packing of grains whose values are known.

#include "tools/fields/sand_motion.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/tools/fields/made_scene.h"
#include "tools/fields/sand_packing.h"

using namespace hoof;
using namespace hoof::tests;
using namespace hoof::tools;

TEST_CASE("a quantile is the value that its share of the weight does not exceed") {
  const std::vector<std::pair<double, double>> values = {{3, 1}, {1, 1}, {2, 2}};
  CHECK(weighted_quantile(values, 0.25) == 1);
  CHECK(weighted_quantile(values, 0.26) == 2);
  CHECK(weighted_quantile(values, 0.75) == 2);
  CHECK(weighted_quantile(values, 0.9) == 3);
  CHECK(weighted_quantile({}, 0.5) == 0);
  CHECK(weighted_quantile({{4, 0}}, 0.5) == 0);
}

TEST_CASE("a grain's energy is of its motion and its spin") {
  Made made({box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.01})});
  made.grain({0, 0, -0.01}, 2e-3, {0.3, -0.4, 0});
  made.moment.sand.grains[0].w_rad_s = {0, 0, 100};
  const FieldScene scene(made.setting, made.moment);
  const double mass_kg =
      made.setting.dem.grain_material.density_kg_m3 * 4 / 3 * std::numbers::pi * 8e-9;
  CHECK(kinetic_J(scene, made.moment.sand.grains[0]) ==
        Approx(0.5 * mass_kg * (0.25 + 0.4 * 4e-6 * 1e4)));
}

TEST_CASE("nine tenths of the energy are found where they are") {
  // Ten grains of equal energy in a column, one each 2 mm: nine lie above 18 mm.
  Made made({box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.01})});
  const double sign = GENERATE(-1.0, 1.0);
  for (int k = 0; k < 10; ++k) made.grain({0, 0, -0.001 - 0.002 * k}, 1e-3, {0, 0, sign});
  const KineticExtent e = kinetic_extent(FieldScene(made.setting, made.moment), 0.002);
  CHECK(e.total_J == Approx(10 * 0.5 * made.setting.dem.grain_material.density_kg_m3 * 4 / 3 *
                            std::numbers::pi * 1e-9));
  CHECK(e.depth_m == Approx(0.019));
  CHECK(e.length_m == 0);
  CHECK(e.width_m == 0);
  CHECK(e.volume_m3 == Approx(9 * 8e-9));
  const Made nothing({box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.01})});
  CHECK(kinetic_extent(FieldScene(nothing.setting, nothing.moment), 0.002).total_J == 0);
}

TEST_CASE("ways are found by the grains' numbers, whatever else came or went") {
  Made then({box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.01})});
  then.grain({0, 0, -0.01}), then.grain({0.005, 0, -0.01}), then.grain({0, 0.005, -0.01});
  Made now = then;
  now.moment.sand.grains.erase(now.moment.sand.grains.begin());
  now.moment.sand.grains[0].p_m += Eigen::Vector3d(-1e-3, 2e-3, 0);
  now.moment.sand.grains.push_back({7, 1e-3, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const auto ways = displacements_m(then.moment, now.moment);
  REQUIRE(ways.size() == 3);
  CHECK((ways[0] - Eigen::Vector3d(-1e-3, 2e-3, 0)).norm() < 1e-15);
  CHECK(ways[1].norm() == 0);
  CHECK(ways[2].norm() == 0);  // not seen then
}

TEST_CASE("rearward is against x, weighted by mass, and only of grains at that part") {
  const double sign = GENERATE(-1.0, 1.0);
  Made made({box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.01})});
  made.grain({0, 0, -2e-3}, 2e-3, {-0.1 * sign, 0, 0});
  made.grain({0.005, 0.005, -1.5e-3}, 1e-3, {-0.4 * sign, 9, 9});
  made.grain({0, 0, -4.1e-3}, 2e-3, {5, 0, 0});  // its top is 2.1 mm below, d50 / 2 is 2 mm
  const FieldScene scene(made.setting, made.moment);
  const RearwardSpeed sole = rearward_speed(scene, FootPart::kSole);
  CHECK(sole.grains == 2);
  CHECK(sole.mean_m_s == Approx(sign * (8 * 0.1 + 0.4) / 9));
  CHECK(sole.largest_m_s == Approx(sign > 0 ? 0.4 : -0.1));
  CHECK(rearward_speed(scene, FootPart::kSpine).grains == 0);
}

TEST_CASE("a grain counts with the share of its volume inside") {
  const double r = 2e-3, full = 4.0 / 3 * std::numbers::pi * r * r * r;
  const std::vector<sim::Grain> one = {{0, r, {1, 2, 3}, {0, 0, 0}, {0, 0, 0}}};
  const auto below = [](double z) { return [z](const Eigen::Vector3d& p) { return p.z() < z; }; };
  CHECK(solid_volume_m3(one, below(4)) == Approx(full));
  CHECK(solid_volume_m3(one, below(2)) == 0);
  CHECK(solid_volume_m3(one, below(3)) == Approx(0.5 * full));
  // A cap of height h: pi h^2 (r - h / 3); the lattice has 272 points.
  const double h = 1e-3;
  CHECK(solid_volume_m3(one, below(3 - r + h)) ==
        Approx(std::numbers::pi * h * h * (r - h / 3)).epsilon(0.1));
}

TEST_CASE("the share of solids of a cubic lattice is pi / 6") {
  std::vector<sim::Grain> grains;
  const double r = 1e-3;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      for (int k = -4; k <= 4; ++k) {
        grains.push_back({0, r, 2 * r * Eigen::Vector3d(i, j, k), {0, 0, 0}, {0, 0, 0}});
      }
    }
  }
  for (const double shift : {0.0, 0.41}) {
    const double half = 2.5 * 2 * r;  // of a box of five cells a side
    const double solid = solid_volume_m3(grains, [&](const Eigen::Vector3d& p) {
      return (p - Eigen::Vector3d::Constant(shift * r)).cwiseAbs().maxCoeff() < half;
    });
    CHECK(solid / std::pow(2 * half, 3) == Approx(std::numbers::pi / 6).epsilon(0.02));
  }
}

TEST_CASE("grains with no or one partner do not carry") {
  // A chain of three and a loner: partners 1, 2, 1, 0.
  Made made({box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.01})});
  for (int k = 0; k < 3; ++k) made.grain({0.00399 * k, 0, -0.01});
  made.grain({0, 0.02, -0.01});
  made.touch_all();
  const Coordination c = coordination(FieldScene(made.setting, made.moment),
                                      [](const Eigen::Vector3d&) { return true; });
  CHECK(c.grains == 4);
  CHECK(c.mean == 1);
  CHECK(c.mechanical == 2);
  // The foot is one partner, however many spots it touches at.
  made.press(3, 0, 0, {0, 0.02, -0.00801}, 1);
  made.press(3, 0, 1, {0.00199, 0.02, -0.01}, 1);
  CHECK(coordination(FieldScene(made.setting, made.moment), [](const Eigen::Vector3d&) {
          return true;
        }).mean == Approx(5.0 / 4));
}
