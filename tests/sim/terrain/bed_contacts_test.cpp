#include "sim/terrain/bed_contacts.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim/terrain/small_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

constexpr double kLarge_m = 2e-3, kSmall_m = 1e-3;  // radii

DemSettings settings(bool periodic = false) {
  BedSettings bed = small_bed();
  bed.periodic_sides = periodic;
  return dem_settings(bed, shipped_materials(), 1);
}

/// 4/3 E* sqrt(R*) delta^(3/2), Hertz 1882; E* = E / (2 (1 - nu^2)) for equal materials.
double hertz_N(double overlap_m) {
  const double E_eff_Pa = 178.5e6 / (2 * (1 - 0.25 * 0.25));
  const double R_eff_m = kLarge_m * kSmall_m / (kLarge_m + kSmall_m);
  return 4.0 / 3 * E_eff_Pa * std::sqrt(R_eff_m) * std::pow(overlap_m, 1.5);
}

BedState pair_along(const Eigen::Vector3d& n, double overlap_m, const Eigen::Vector3d& middle_m) {
  BedState state;
  const Eigen::Vector3d apart = (kLarge_m + kSmall_m - overlap_m) * n;
  state.grains = {{3, kLarge_m, middle_m, {0, 0, 0}, {0, 0, 0}},
                  {8, kSmall_m, middle_m + apart, {0, 0, 0}, {0, 0, 0}}};
  state.contacts = {{3, 8, Eigen::Vector3d::Zero()}};
  return state;
}

}  // namespace

TEST_CASE("a pair at rest pushes apart with Hertz's force, each its own way") {
  const double side = GENERATE(-1, 1);
  const Eigen::Vector3d n = side * Eigen::Vector3d(1, 2, -2) / 3;
  const double overlap_m = 3e-6;
  const Eigen::Vector3d at(0.001, 0.002, -0.01);
  const BedState state = pair_along(n, overlap_m, at);
  const auto contacts = loaded_contacts(settings(), state);
  REQUIRE(contacts.size() == 1);
  const LoadedContact& c = contacts[0];
  CHECK(c.i == 3);
  CHECK(c.j == 8);
  CHECK(c.overlap_m == Approx(overlap_m));
  CHECK(c.overlap_ratio == Approx(overlap_m / kSmall_m));
  // Rounding of metres against micrometres: 1e-17 of 3e-6, times 3/2.
  CHECK((c.f_normal_N + hertz_N(overlap_m) * n).norm() < 1e-9 * hertz_N(overlap_m));
  CHECK(c.f_tangential_N.norm() == 0);
  CHECK((c.p_m - (at + (kLarge_m - overlap_m / 2) * n)).norm() < 1e-15);
  CHECK((at + c.to_j_m - state.grains[1].p_m).norm() < 1e-15);
  const auto sums = forces_on_grains(state, contacts);
  CHECK((sums[0] - c.f_normal_N).norm() == 0);
  CHECK((sums[0] + sums[1]).norm() == 0);
}

TEST_CASE("grains that have parted carry nothing") {
  CHECK(loaded_contacts(settings(), pair_along({1, 0, 0}, -1e-9, {0, 0, -0.01})).empty());
}

TEST_CASE("a pair across periodic sides touches, one across walls does not") {
  const double side = GENERATE(-1, 1);
  BedState state = pair_along({side, 0, 0}, 3e-6, {side * 0.0295, 0, -0.01});
  state.grains[1].p_m.x() -= side * 0.06;  // as the engine keeps it, inside of the box
  const auto contacts = loaded_contacts(settings(true), state);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].f_normal_N.x() == Approx(-side * hertz_N(3e-6)));
  CHECK(contacts[0].to_j_m.x() == Approx(side * (kLarge_m + kSmall_m - 3e-6)));
  CHECK(loaded_contacts(settings(false), state).empty());
}

TEST_CASE("a spring along a wall pulls back, up to the friction") {
  // Wall 1 is at x = -30 mm. Hertz against the wall: R* = r; Mindlin: 8 G* sqrt(r delta) xi.
  const double overlap_m = 2e-6;
  BedState state;
  state.grains = {{0, kLarge_m, {-0.030 + kLarge_m - overlap_m, 0, -0.01}, {0, 0, 0}, {0, 0, 0}}};
  const Materials m = shipped_materials();
  const auto shear = [](const Material& a) {
    return a.young_Pa.value / (2 * (1 + a.poisson.value));
  };
  const auto plane = [](const Material& a) {
    return (1 - a.poisson.value * a.poisson.value) / a.young_Pa.value;
  };
  const double G_eff_Pa =
      1 / ((2 - m.sand.poisson.value) / shear(m.sand) + (2 - m.abs.poisson.value) / shear(m.abs));
  const double E_eff_Pa = 1 / (plane(m.sand) + plane(m.abs));
  const double a_m = std::sqrt(kLarge_m * overlap_m);
  const double normal_N = 4.0 / 3 * E_eff_Pa * a_m * overlap_m;
  const double limit_N = m.sand_abs.static_friction.value * normal_N;
  const double slip_m = limit_N / (8 * G_eff_Pa * a_m);
  for (const double share : {-2.0, -0.5, 0.5, 2.0}) {
    state.contacts = {{0, GrainContact::kWallContact + 1, {0, share * slip_m, 0}}};
    const auto contacts = loaded_contacts(settings(), state);
    REQUIRE(contacts.size() == 1);
    CHECK(contacts[0].f_normal_N.x() == Approx(normal_N));
    CHECK(contacts[0].f_tangential_N.y() == Approx(-limit_N * std::clamp(share, -1.0, 1.0)));
    CHECK(contacts[0].p_m.x() == Approx(-0.030));
  }
}

TEST_CASE("contacts of what is not there are refused") {
  BedState state = pair_along({1, 0, 0}, 3e-6, {0, 0, -0.01});
  state.contacts = {{3, 5, Eigen::Vector3d::Zero()}};
  CHECK_THROWS_WITH(loaded_contacts(settings(), state),
                    "bed: a contact names grain 5, which is not there");
  state.contacts = {{3, GrainContact::kWallContact + 2, Eigen::Vector3d::Zero()}};
  CHECK_THROWS_WITH(loaded_contacts(settings(true), state), "bed: a contact names wall 2 of 2");
}

TEST_CASE("in a bed at rest the contacts carry each grain's weight") {
  BedSettings bed = small_bed();
  bed.periodic_sides = GENERATE(false, true);
  const BedState state = make_small_bed(bed);
  const auto contacts = loaded_contacts(dem_settings(bed, shipped_materials(), 1), state);
  const auto f_N = forces_on_grains(state, contacts);
  double weight_N = 0, borne_N = 0, floor_N = 0, unbalanced_N = 0;
  for (std::size_t i = 0; i < f_N.size(); ++i) {
    const double g_N = 2650 * 9.81 * sphere_m3(2 * state.grains[i].radius_m);
    weight_N += g_N;
    unbalanced_N += (f_N[i] - Eigen::Vector3d(0, 0, g_N)).norm();
  }
  for (const LoadedContact& c : contacts) {
    if (c.j >= GrainContact::kWallContact) borne_N += c.f_normal_N.z() + c.f_tangential_N.z();
    if (c.j == GrainContact::kWallContact) floor_N += c.f_normal_N.z();
  }
  // What is left keeps the rattlers in motion and is the rounding of 32 bit histories.
  CHECK(unbalanced_N < 0.1 * weight_N);
  // Floor and walls bear all of the weight: 5 % for the bed's sloshing. The floor's part may be
  // more where walls hold the bed down by friction (1.14 measured: it rises when it is scraped
  // off).
  CHECK(borne_N == Approx(weight_N).epsilon(0.05));
  CHECK(floor_N == Approx(weight_N).epsilon(bed.periodic_sides ? 0.05 : 0.5));
}
