// Plates in sand: each effect against the contract's words.

#include "tools/conceal/sand_bench.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace hoof::tools::conceal;

namespace {

SandPress press_of(double speed_m_s) {
  SandPress press;
  press.width_m = press.length_m = 0.08;
  press.start_height_m = press.surface_height_m = 0.1;
  press.travel.moves = {{0.0, 0.02 / speed_m_s, 0.02, false}};
  for (int i = 0; i <= 100; ++i) press.times_s.push_back(i * 0.01 * 0.02 / speed_m_s);
  return press;
}

const SandBed kBed{2e4, 3e6, 1.1};

double middle(const std::vector<HiddenEffect>& hidden, const SandPress& press) {
  return sand_force(kBed, hidden, press, carriage_depth(press))[50];
}

double law(double z) {
  return 0.25 * std::numbers::pi * 0.08 * 0.08 * (2e4 / 0.04 + 3e6) * std::pow(z, 1.1);
}

}  // namespace

TEST_CASE("Bekker's law, nothing above the surface") {
  SandPress press = press_of(0.004);
  CHECK(middle({}, press) == Approx(law(0.01)).epsilon(1e-6));
  press.surface_height_m = 0.07;
  CHECK(middle({}, press) == 0.0);
}

TEST_CASE("speed, order and strength of a press add as the contract has it") {
  SandPress press = press_of(0.004);
  CHECK(middle({{"rate_dependence", true, {{"coefficient", 20.0, "s/m"}}}}, press) ==
        Approx(law(0.01) * 1.08).epsilon(1e-5));
  press.index = 3;
  CHECK(middle({{"packing_change", true, {{"drift", -0.05, "1 per press"}}}}, press) ==
        Approx(law(0.01) * 0.85).epsilon(1e-6));
  CHECK(middle({{"cohesion", true, {{"strength", 500.0, "Pa"}}}}, press) ==
        Approx(law(0.01) + 500.0 * press.area_m2()).epsilon(1e-6));
  CHECK(middle({{"hard_layer", true, {{"depth", 0.006, "m"}, {"ratio", 2.5, "1"}}}}, press) ==
        Approx(law(0.006) + 2.5 * (law(0.01) - law(0.006))).epsilon(1e-6));
}

TEST_CASE("a rig that bends: the plate is where travel less compliance times force has it") {
  const SandPress press = press_of(0.004);
  const double force = middle({{"rig_compliance", true, {{"compliance", 2e-5, "m/N"}}}}, press);
  CHECK(force == Approx(law(0.01 - 2e-5 * force)).epsilon(1e-9));
  CHECK(force < law(0.01));
}

TEST_CASE("unloading is steeper than loading and comes back on the same way") {
  SandPress press = press_of(0.004);
  press.travel.moves = {
      {0.0, 1.0, 0.02, false}, {2.0, 1.0, -0.004, false}, {4.0, 1.0, 0.004, false}};
  press.times_s = {0.0, 1.5, 3.5, 5.5};
  const auto force = sand_force(kBed, {{"unload_hysteresis", true, {{"ratio", 2.0, "1"}}}}, press,
                                carriage_depth(press));
  CHECK(force[2] == Approx(law(0.02) - 2.0 * (law(0.02) - law(0.016))).epsilon(1e-6));
  CHECK(force[3] == Approx(force[1]).epsilon(1e-9));
}

TEST_CASE("presses that are each quicker by the same: rate and packing are one") {
  const double scale = 1.0 + 20.0 * 0.003;
  for (int i = 0; i < 5; ++i) {
    SandPress press = press_of(0.003 + 0.0015 * i);
    press.index = i;
    const double rate = middle({{"rate_dependence", true, {{"coefficient", 20.0, "s/m"}}}}, press);
    const double packing = middle(
        {{"packing_change", true, {{"drift", 20.0 * 0.0015 / scale, "1 per press"}}}}, press);
    CHECK(rate == Approx(scale * packing).epsilon(1e-5));
  }
}
