#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/effects/soil_effect_maker.h"

namespace hoof::tests {
namespace {

using sim::soil_force_N;
using sim::SoilContact;

double nominal_N(const SoilContact& contact) {
  return contact.stiffness_N_m * std::pow(contact.depth_m, contact.exponent);
}

/// Values at which an effect is nothing.
const std::vector<std::pair<std::string, std::vector<double>>> kNothing = {
    {"rig_compliance", {0}},
    {"plate_size_law", {0}},
    {"rate_dependence", {0}},
    {"cohesion", {0}},
    {"wall_confinement", {0}},
    {"hard_layer", {0.005, 1}},
    {"hard_layer", {1, 7}},
    {"packing_change", {0}},
    {"unload_hysteresis", {1}},
    {"slip_sinkage", {0}},
    {"spine_wear", {0}},
    {"unlisted_force_offset", {0, 0}},
    {"unlisted_bearing_limit", {0}},
    {"unlisted_crust", {0, 0.003}},
    {"unlisted_force_wave", {0, 0.01, 1}},
    {"unlisted_side_friction", {0}},
    {"unlisted_surface_offset", {0}},
    {"unlisted_rig_settling", {0, 10}},
    {"unlisted_relaxation", {0, 2}}};

TEST_CASE("every effect of soil is listed above and is nothing at those values, to the bit") {
  for (const auto& info : sim::effect_catalogue()) {
    if (!info.make_soil) continue;
    INFO(info.name);
    const auto named = [&](const auto& row) { return row.first == info.name; };
    CHECK(std::count_if(kNothing.begin(), kNothing.end(), named) > 0);
  }
  for (const auto& [name, values] : kNothing) {
    const auto effects = one(name, values);
    for (const double depth_m : {-0.01, 0.0, 1e-5, 0.003, 0.011, 0.04}) {
      SoilContact contact = contact_at(depth_m);
      contact.deepest_m = 0.02;
      contact.press = 3;
      contact.shear_m = 0.1;
      contact.time_s = 100 + depth_m;
      const double plain_N = soil_force_N(contact, {});
      INFO(name << " at " << depth_m);
      CHECK(soil_force_N(contact, effects) == plain_N);
      CHECK(effects[0]->measured_N(plain_N, contact) == plain_N);
      CHECK(effects[0]->extra_depth_m(contact) == 0);
      CHECK(effects[0]->rig_travel_m(plain_N) == 0);
      CHECK(effects[0]->spine_loss_m() == 0);
    }
  }
}

TEST_CASE("names, units and bounds are the contract's") {
  const std::vector<std::array<std::string, 3>> contract = {
      {"rig_compliance", "compliance", "m/N"},
      {"plate_size_law", "exponent", "1"},
      {"rate_dependence", "coefficient", "s/m"},
      {"cohesion", "strength", "Pa"},
      {"wall_confinement", "coefficient", "1"},
      {"packing_change", "drift", "1 per press"},
      {"unload_hysteresis", "ratio", "1"},
      {"slip_sinkage", "coefficient", "1"},
      {"spine_wear", "loss", "m"}};
  for (const auto& [name, parameter, unit] : contract) {
    const sim::EffectInfo* info = sim::find_effect(name);
    INFO(name);
    REQUIRE(info != nullptr);
    REQUIRE(info->parameters.size() == 1);
    CHECK(info->parameters[0].name == parameter);
    CHECK(info->parameters[0].unit == unit);
    CHECK(info->listed);
  }
  const sim::EffectInfo* layer = sim::find_effect("hard_layer");
  REQUIRE(layer != nullptr);
  REQUIRE(layer->parameters.size() == 2);
  CHECK(layer->parameters[0].name == "depth");
  CHECK(layer->parameters[0].unit == "m");
  CHECK(layer->parameters[1].name == "ratio");
  for (const auto& info : sim::effect_catalogue()) {
    if (!info.make_soil) continue;
    INFO(info.name);
    CHECK(info.listed == !info.name.starts_with("unlisted_"));
    CHECK_FALSE(info.source.empty());
    CHECK_FALSE(info.experiment.empty());
    CHECK_FALSE(info.equation.empty());
    for (const auto& parameter : info.parameters) {
      INFO(parameter.name);
      CHECK(parameter.low < parameter.high);
      CHECK(parameter.typical > 0);
      for (const double start : parameter.starts) {
        CHECK(start >= parameter.low);
        CHECK(start <= parameter.high);
      }
    }
  }
}

TEST_CASE("factors of the nominal strength in closed form, both signs") {
  SoilContact contact = contact_at(0.02);
  const double plain_N = nominal_N(contact);
  SECTION("plate size: the reference of 50 mm is left alone, half of it scales by 2^-exponent") {
    for (const double exponent : {-0.7, 0.4}) {
      contact.width_m = 0.05;
      CHECK(soil_force_N(contact, one("plate_size_law", {exponent})) == Approx(plain_N));
      contact.width_m = 0.025;
      CHECK(soil_force_N(contact, one("plate_size_law", {exponent})) ==
            Approx(plain_N * std::pow(0.5, exponent)));
    }
  }
  SECTION("rate: downward only, and never a pull") {
    for (const double coefficient : {-50.0, 30.0}) {
      const auto rate = one("rate_dependence", {coefficient});
      contact.speed_m_s = 0.004;
      CHECK(soil_force_N(contact, rate) == Approx(plain_N * (1 + 0.004 * coefficient)));
      contact.speed_m_s = -0.004;
      CHECK(soil_force_N(contact, rate) == plain_N);
    }
    contact.speed_m_s = 1;
    CHECK(soil_force_N(contact, one("rate_dependence", {-50})) == 0);
  }
  SECTION("wall: with the square of depth over distance; 0.1 m where it is not known") {
    CHECK(soil_force_N(contact, one("wall_confinement", {5})) == Approx(plain_N * 1.2));
    contact.wall_distance_m = 0.04;
    CHECK(soil_force_N(contact, one("wall_confinement", {5})) == Approx(plain_N * 2.25));
  }
  SECTION("packing: by as many presses as went before; loosened to nothing, not beyond") {
    for (const int press : {0, 1, 4}) {
      contact.press = press;
      CHECK(soil_force_N(contact, one("packing_change", {0.1})) ==
            Approx(plain_N * (1 + 0.1 * press)));
    }
    CHECK(soil_force_N(contact, one("packing_change", {-0.1})) == Approx(plain_N * 0.6));
    CHECK(soil_force_N(contact, one("packing_change", {-0.5})) == 0);
  }
}

TEST_CASE("cohesion adds its strength over the area, whole below a tenth of a millimetre") {
  const double strength_Pa = 3000;
  const auto cohesion = one("cohesion", {strength_Pa});
  for (const double depth_m : {0.00011, 0.002, 0.03}) {
    const SoilContact contact = contact_at(depth_m);
    CHECK(soil_force_N(contact, cohesion) ==
          Approx(nominal_N(contact) + strength_Pa * contact.area_m2));
  }
  const SoilContact half = contact_at(0.00005);
  CHECK(soil_force_N(half, cohesion) == Approx(nominal_N(half) + strength_Pa * half.area_m2 / 2));
  CHECK(soil_force_N(contact_at(1e-9), cohesion) < 1e-3);
  CHECK(soil_force_N(contact_at(-1e-9), cohesion) == 0);
}

TEST_CASE("a layer multiplies the slope below its depth and keeps the force continuous") {
  const double depth_m = 0.012;
  for (const double ratio : {0.3, 4.0}) {
    const auto layer = one("hard_layer", {depth_m, ratio});
    CHECK(soil_force_N(contact_at(0.011), layer) == nominal_N(contact_at(0.011)));
    const double above_N = soil_force_N(contact_at(depth_m - 1e-9), layer);
    CHECK(soil_force_N(contact_at(depth_m + 1e-9), layer) == Approx(above_N).epsilon(1e-5));
    const auto slope = [&](double at_m, sim::SoilEffects effects) {
      return soil_force_N(contact_at(at_m + 1e-6), effects) -
             soil_force_N(contact_at(at_m - 1e-6), effects);
    };
    for (const double at_m : {0.013, 0.03}) {
      CHECK(slope(at_m, layer) == Approx(ratio * slope(at_m, {})).epsilon(1e-6));
    }
  }
}

TEST_CASE("unloading starts at the force of loading, is ratio times as steep and ends at zero") {
  const double ratio = 6;
  const auto unload = one("unload_hysteresis", {ratio});
  SoilContact contact = contact_at(0.02);
  contact.deepest_m = 0.02;
  const double deepest_N = nominal_N(contact);
  CHECK(soil_force_N(contact, unload) == deepest_N);
  contact.depth_m = 0.019;
  const double loading_N = nominal_N(contact);
  CHECK(soil_force_N(contact, unload) == Approx(deepest_N - ratio * (deepest_N - loading_N)));
  contact.depth_m = 0.015;
  CHECK(soil_force_N(contact, unload) == 0);
  // Deeper than ever: loading as always.
  contact.depth_m = 0.025;
  CHECK(soil_force_N(contact, unload) == nominal_N(contact));
}

TEST_CASE("unloading is continuous where other effects act as well, at a speed that turns") {
  SoilEffectList effects;
  effects.push_back(make_soil_effect("cohesion", {2000}));
  effects.push_back(make_soil_effect("hard_layer", {0.01, 3}));
  effects.push_back(make_soil_effect("rate_dependence", {20}));
  effects.push_back(make_soil_effect("unload_hysteresis", {5}));
  effects.push_back(make_soil_effect("wall_confinement", {2}));
  SoilContact contact = contact_at(0.02);
  contact.speed_m_s = 0;
  contact.deepest_m = 0.02;
  const double turning_N = soil_force_N(contact, effects);
  contact.depth_m -= 1e-9;
  contact.speed_m_s = -1e-9;
  CHECK(soil_force_N(contact, effects) == Approx(turning_N).epsilon(1e-5));
  // Pressed again, at speed: no step where the deepest point is passed.
  contact.speed_m_s = 0.01;
  const double before_N = soil_force_N(contact, effects);
  contact.depth_m = 0.02 + 1e-9;
  CHECK(soil_force_N(contact, effects) == Approx(before_N).epsilon(1e-5));
  CHECK(before_N > 1.1 * turning_N);
}

TEST_CASE("rigs, feet and shear") {
  CHECK(one("rig_compliance", {2e-6})[0]->rig_travel_m(150) == Approx(3e-4));
  CHECK(one("spine_wear", {0.003})[0]->spine_loss_m() == 0.003);
  const auto slip = one("slip_sinkage", {0.2});
  SoilContact contact = contact_at(0.02);
  contact.shear_m = 0.05;
  CHECK(slip[0]->extra_depth_m(contact) == Approx(-0.01));
  contact.shear_m = 5;  // never out of the ground
  CHECK(slip[0]->extra_depth_m(contact) == Approx(-0.02));
  contact.depth_m = -0.02;
  CHECK(slip[0]->extra_depth_m(contact) == 0);
}

}  // namespace
}  // namespace hoof::tests
