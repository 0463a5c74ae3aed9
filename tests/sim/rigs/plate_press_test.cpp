#include "sim/rigs/plate_press.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/sim/effects/soil_effect_maker.h"

namespace hoof::tests {
namespace {

using sim::PressBench;
using sim::PressPath;

PressBench bench() {
  return {.plate = sim::disc(0.08),
          .soil = {.k_c = 1e4, .k_phi = 3e6, .n = 1.2},
          .surface_height_m = -0.009,
          .wall_distance_m = 0};
}

/// Depths at 50 Hz as heights above a surface at -9 mm, with the speeds that they have.
PressPath path_of(const std::vector<double>& depths_m) {
  PressPath path;
  for (std::size_t i = 0; i < depths_m.size(); ++i) {
    path.time_s.push_back(0.02 * static_cast<double>(i));
    path.height_m.push_back(-0.009 - depths_m[i]);
    path.speed_m_s.push_back(i == 0 ? 0.0 : (depths_m[i] - depths_m[i - 1]) / 0.02);
  }
  path.press.assign(depths_m.size(), 0);
  return path;
}

/// Down to `deepest_m` and back, 40 samples each way, from and to 2 mm above the sand.
std::vector<double> there_and_back(double deepest_m) {
  std::vector<double> depths_m;
  for (int i = -40; i <= 40; ++i) {
    depths_m.push_back(-0.002 + (deepest_m + 0.002) * (1 - std::abs(i) / 40.0));
  }
  return depths_m;
}

TEST_CASE("plates: a disc has its radius as smaller dimension, a rectangle its smaller side") {
  CHECK(sim::disc(0.1).area_m2 == Approx(std::numbers::pi * 0.0025));
  CHECK(sim::disc(0.1).width_m == 0.05);
  for (const auto& plate : {sim::rectangle(0.03, 0.2), sim::rectangle(0.2, 0.03)}) {
    CHECK(plate.area_m2 == Approx(0.006));
    CHECK(plate.width_m == 0.03);
  }
}

TEST_CASE("Bekker's law at hand-made numbers, the same down and up, nothing in the air") {
  // A = 5.026548e-3 m2, k_c/b + k_phi = 1e4/0.04 + 3e6 = 3.25e6, 0.01^1.2 = 3.981072e-3
  const auto forces_N =
      sim::press_sand_N(bench(), path_of({-0.005, 0.0, 0.01, 0.02, 0.01, 0.0, -0.005}), {});
  CHECK(forces_N[0] == 0);
  CHECK(forces_N[1] == 0);
  CHECK(forces_N[2] == Approx(65.0361).epsilon(1e-5));
  CHECK(forces_N[3] == Approx(65.0361 * std::pow(2, 1.2)).epsilon(1e-5));
  CHECK(forces_N[4] == forces_N[2]);
  CHECK(forces_N[6] == 0);
}

TEST_CASE("a negative modulus makes no pull") {
  PressBench weak = bench();
  weak.soil.k_c = -1e6;
  CHECK(sim::plate_stiffness(weak.plate, weak.soil) == 0);
  CHECK(sim::press_sand_N(weak, path_of({0.01}), {})[0] == 0);
}

TEST_CASE("compliance: force and depth agree with each other at every sample") {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 300; ++trial) {
    const double compliance_m_N = std::pow(10.0, -7 + 4e-3 * double(random() % 1000));
    const double depth_m = 1e-5 * double(1 + random() % 5000);
    const auto rig = one("rig_compliance", {compliance_m_N});
    const double force_N = sim::press_sand_N(bench(), path_of({depth_m}), rig)[0];
    const double left_m = depth_m - compliance_m_N * force_N;
    INFO("compliance " << compliance_m_N << ", depth " << depth_m << ", force " << force_N);
    REQUIRE(left_m >= 0);
    // Conditioned by how much the rig takes up.
    const double expected_N = sim::press_sand_N(bench(), path_of({left_m}), {})[0];
    CHECK(compliance_m_N * std::abs(force_N - expected_N) < 1e-11 + 1e-9 * depth_m);
  }
}

TEST_CASE("compliance closed form: exponent one is two springs in series") {
  PressBench linear = bench();
  linear.soil.n = 1;
  const double stiffness_N_m = sim::plate_stiffness(linear.plate, linear.soil);
  for (const double compliance_m_N : {1e-6, 2e-5, 1e-3}) {
    const auto rig = one("rig_compliance", {compliance_m_N});
    const auto forces_N = sim::press_sand_N(linear, path_of({-0.001, 0.004, 0.03}), rig);
    CHECK(forces_N[0] == 0);
    CHECK(forces_N[1] == Approx(0.004 / (1 / stiffness_N_m + compliance_m_N)).epsilon(1e-9));
    CHECK(forces_N[2] == Approx(0.03 / (1 / stiffness_N_m + compliance_m_N)).epsilon(1e-9));
  }
}

TEST_CASE(
    "unloading on a rig that bends: from the deepest force down, reloading on the same line") {
  SoilEffectList effects;
  effects.push_back(make_soil_effect("rig_compliance", {2e-5}));
  effects.push_back(make_soil_effect("unload_hysteresis", {8}));
  const auto plain = one("rig_compliance", {2e-5});
  const std::vector<double> depths_m = {0.01, 0.02, 0.019, 0.0185, 0.019, 0.02, 0.022};
  const auto with_N = sim::press_sand_N(bench(), path_of(depths_m), effects);
  const auto without_N = sim::press_sand_N(bench(), path_of(depths_m), plain);
  CHECK(with_N[0] == without_N[0]);
  CHECK(with_N[1] == without_N[1]);
  CHECK(with_N[2] < without_N[2]);
  CHECK(with_N[3] < with_N[2]);
  CHECK(with_N[4] == Approx(with_N[2]).epsilon(1e-9));
  CHECK(with_N[5] == Approx(with_N[1]).epsilon(1e-9));
  CHECK(with_N[6] == Approx(without_N[6]).epsilon(1e-12));
}

TEST_CASE("the second press forgets the deepest point of the first") {
  const auto unload = one("unload_hysteresis", {10});
  auto depths_m = there_and_back(0.02);
  const auto again = there_and_back(0.02);
  depths_m.insert(depths_m.end(), again.begin(), again.end());
  const auto forces_N = sim::press_sand_N(bench(), path_of(depths_m), unload);
  for (std::size_t i = 0; i < again.size(); ++i) CHECK(forces_N[i] == forces_N[i + again.size()]);
  CHECK(forces_N[30] > 0);
  CHECK(forces_N[50] == 0);  // the same depth on the way up
}

TEST_CASE("force is continuous along a path, each effect at its typical size") {
  for (const auto& info : sim::effect_catalogue()) {
    if (!info.make_soil) continue;
    std::vector<double> values;
    for (const auto& parameter : info.parameters) values.push_back(parameter.typical);
    SoilEffectList effects;
    effects.push_back(info.make_soil(values));
    // One micrometre a step: no step of the force may be larger than a few of its slopes.
    std::vector<double> depths_m;
    for (int i = 0; i <= 25000; ++i) depths_m.push_back(1e-6 * i);
    for (int i = 25000; i >= 0; --i) depths_m.push_back(1e-6 * i);
    PressPath path = path_of(depths_m);
    for (double& speed : path.speed_m_s) speed = 0;
    const auto forces_N = sim::press_sand_N(bench(), path, effects);
    double largest_N = 0;
    for (std::size_t i = 1; i < forces_N.size(); ++i) {
      largest_N = std::max(largest_N, std::abs(forces_N[i] - forces_N[i - 1]));
    }
    INFO(info.name);
    CHECK(largest_N < 0.2);  // nominal: 0.009 N a step at the deepest; five times when unloading
  }
}

TEST_CASE(
    "a press on a block: the height of contact, less what the rig travels, never under a pull") {
  const std::vector<double> forces_N = {0, 100, 250, 100, -20};
  for (const double height_m : sim::press_block_m(0.4, forces_N, {})) CHECK(height_m == 0.4);
  const auto heights_m = sim::press_block_m(0.4, forces_N, one("rig_compliance", {1e-5}));
  CHECK(heights_m[0] == 0.4);
  CHECK(heights_m[2] == Approx(0.4 - 0.0025));
  CHECK(heights_m[3] == heights_m[1]);
  CHECK(heights_m[4] == 0.4);
}

}  // namespace
}  // namespace hoof::tests
