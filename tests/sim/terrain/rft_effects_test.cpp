// Optional physics of the soil on a plate of facets, against the effects' own equations.
#include <catch2/catch.hpp>
#include <cmath>

#include "sim/effects/effect.h"
#include "tests/sim/terrain/soil_plate.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

constexpr double kArea_m2 = 0.1 * 0.05;
constexpr double kSpeed_m_s = 0.1;  // of Stroke::by: 5 um in 50 us

std::unique_ptr<SoilEffect> effect(const char* name, std::vector<double> values) {
  return find_effect(name)->make_soil(values);
}

RftTerrainSettings settings(PressureLaw law) {
  RftTerrainSettings s = soil();
  s.pressure_law = law;
  return s;
}

double nominal_N(PressureLaw law, double depth_m) {
  return law == PressureLaw::kLinear ? 5e5 * kArea_m2 * depth_m * rft::flat_plate_alpha()
                                     : kArea_m2 * (1e3 / 0.05 + 2e5) * std::pow(depth_m, 0.7);
}

/// Force on a level plate that goes down to this depth at kSpeed_m_s.
double press_N(PressureLaw law, double depth_m, std::unique_ptr<SoilEffect> added) {
  RftTerrain terrain(settings(law));
  if (added) terrain.add_effect(std::move(added));
  Stroke stroke(terrain, sheet(0.1, 0.05), {{0, 0, 0.001}, Eigen::Quaterniond::Identity()});
  return stroke.by({0, 0, -depth_m - 0.001}).f_W_N.z();
}

}  // namespace

TEST_CASE("effects of the soil act on a plate of facets as on a plate") {
  const PressureLaw law = GENERATE(PressureLaw::kLinear, PressureLaw::kBekker);
  const double z = GENERATE(0.004, 0.02);
  CAPTURE(int(law), z);
  const double F = nominal_N(law, z);
  CHECK(press_N(law, z, nullptr) == Approx(F));
  CHECK(press_N(law, z, effect("cohesion", {3000})) == Approx(F + 3000 * kArea_m2));
  CHECK(press_N(law, z, effect("rate_dependence", {2})) == Approx(F * (1 + 2 * kSpeed_m_s)));
  CHECK(press_N(law, z, effect("wall_confinement", {5})) ==
        Approx(F * (1 + 5 * z * z / (0.1 * 0.1))));
  const double at_layer = nominal_N(law, 0.01);
  CHECK(press_N(law, z, effect("hard_layer", {0.01, 4})) ==
        Approx(z > 0.01 ? at_layer + 4 * (F - at_layer) : F));
}

TEST_CASE("effects of no size leave the bytes of none") {
  const PressureLaw law = GENERATE(PressureLaw::kLinear, PressureLaw::kBekker);
  for (const double z : {0.0001, 0.003, 0.02}) {
    const double without = press_N(law, z, nullptr);
    CHECK(press_N(law, z, effect("cohesion", {0})) == without);
    CHECK(press_N(law, z, effect("rate_dependence", {0})) == without);
    CHECK(press_N(law, z, effect("wall_confinement", {0})) == without);
    CHECK(press_N(law, z, effect("hard_layer", {0.01, 1})) == without);
    CHECK(press_N(law, z, effect("slip_sinkage", {0})) == without);
    CHECK(press_N(law, z, effect("spine_wear", {0.002})) == without);  // of the foot, not the soil
  }
}

TEST_CASE("a plate that is dragged digs in: it meets the force of coefficient times way less") {
  const double way_m = GENERATE(0.01, 0.05);
  const auto drag = [way_m](std::unique_ptr<SoilEffect> added) {
    RftTerrain terrain(soil());
    if (added) terrain.add_effect(std::move(added));
    Stroke stroke(terrain, sheet(0.1, 0.05), {{0, 0, 0.001}, Eigen::Quaterniond::Identity()});
    stroke.by({0, 0, -0.021});
    stroke.by({way_m, 0, 0});
    // Down again, so that the plate's own direction of flow is the same as before.
    return stroke.by({0, 0, -0.004}).f_W_N.z();
  };
  const double z = 0.024, dug_m = 0.2 * way_m;
  CHECK(drag(effect("slip_sinkage", {0.2})) / drag(nullptr) ==
        Approx((z - dug_m) / z).epsilon(1e-6));
}
