#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim/effects/soil_effect_maker.h"

namespace hoof::tests {
namespace {

using sim::soil_force_N;
using sim::SoilContact;

TEST_CASE("a sensor's zero and its creep are there in the air as well") {
  const auto offset = one("unlisted_force_offset", {1.5, -0.2});
  SoilContact contact = contact_at(-0.01);
  contact.time_s = 4;
  CHECK(offset[0]->measured_N(0, contact) == Approx(0.7));
  CHECK(offset[0]->measured_N(20, contact) == Approx(20.7));
}

TEST_CASE(
    "the pressure levels off at one over softness, and half of that where it would reach it") {
  const auto limit = one("unlisted_bearing_limit", {1e-5});
  SoilContact contact = contact_at(0.02);
  contact.stiffness_N_m *= 1e6;
  CHECK(soil_force_N(contact, limit) / contact.area_m2 == Approx(1e5).epsilon(1e-3));
  contact.stiffness_N_m = 1e5 * contact.area_m2 / std::pow(0.02, 1.2);
  CHECK(soil_force_N(contact, limit) / contact.area_m2 == Approx(0.5e5));
}

TEST_CASE("a crust is strongest at its depth and soon passed, both signs") {
  for (const double strength_Pa : {-1000.0, 5000.0}) {
    const auto crust = one("unlisted_crust", {strength_Pa, 0.004});
    const auto extra_N = [&](double depth_m) {
      return crust[0]->force_N(100, contact_at(depth_m)) - 100;
    };
    const double area_m2 = contact_at(0).area_m2;
    CHECK(extra_N(0.004) == Approx(strength_Pa * area_m2));
    CHECK(std::abs(extra_N(0.003)) < std::abs(extra_N(0.004)));
    CHECK(std::abs(extra_N(0.005)) < std::abs(extra_N(0.004)));
    CHECK(std::abs(extra_N(0.06)) < 1e-4 * std::abs(strength_Pa));
  }
  // Weaker than the sand is strong: no pull.
  CHECK(soil_force_N(contact_at(0.001), one("unlisted_crust", {-1e6, 0.004})) == 0);
}

TEST_CASE("a wave of force repeats with its period of depth") {
  const auto wave = one("unlisted_force_wave", {0.2, 0.008, 0.5});
  const auto factor = [&](double depth_m) {
    return soil_force_N(contact_at(depth_m), wave) / soil_force_N(contact_at(depth_m), {});
  };
  CHECK(factor(0.003) == Approx(1 + 0.2 * std::sin(2 * std::numbers::pi * 3 / 8 + 0.5)));
  CHECK(factor(0.003) == Approx(factor(0.011)));
  CHECK(factor(0.003) == Approx(2 - factor(0.007)));
}

TEST_CASE("friction on the side grows with the square of depth and with the plate's girth") {
  const auto side = one("unlisted_side_friction", {3e5});
  const SoilContact contact = contact_at(0.02);
  // A disc of 80 mm has a girth of 0.2513 m; its side bears 3e5 z on the average of 0 to z.
  const double extra_N = soil_force_N(contact, side) - soil_force_N(contact, {});
  CHECK(extra_N == Approx(0.25133 * 3e5 * 0.02 * 0.02 / 2).epsilon(1e-4));
}

TEST_CASE("a rig that settles travels its play and no more") {
  const auto settling = one("unlisted_rig_settling", {4e-4, 15});
  CHECK(settling[0]->rig_travel_m(0) == 0);
  CHECK(settling[0]->rig_travel_m(15) == Approx(4e-4 * (1 - std::exp(-1.0))));
  CHECK(settling[0]->rig_travel_m(1e4) == Approx(4e-4));
}

TEST_CASE(
    "relaxation: a held force falls by its share with its time constant, whatever the steps") {
  for (const double dt_s : {0.01, 0.5}) {
    auto relaxation = one("unlisted_relaxation", {0.3, 2});
    relaxation[0]->reset();
    SoilContact contact = contact_at(0.02);
    double force_N = 0;
    for (int i = 0; i <= static_cast<int>(std::lround(3 / dt_s)); ++i) {
      contact.time_s = 7 + i * dt_s;
      force_N = relaxation[0]->measured_N(80, contact);
      if (i == 0) CHECK(force_N == 80);
    }
    CHECK(force_N == Approx(80 * (1 - 0.3 * (1 - std::exp(-1.5)))));
    contact.depth_m = -0.001;
    contact.time_s += dt_s;
    CHECK(relaxation[0]->measured_N(0, contact) == 0);
    relaxation[0]->reset();
    CHECK(relaxation[0]->measured_N(80, contact_at(0.02)) == 80);
  }
}

}  // namespace
}  // namespace hoof::tests
