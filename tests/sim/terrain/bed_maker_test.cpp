#include "sim/terrain/bed_maker.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "tests/sim/terrain/small_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

double cube(double x) {
  return x * x * x;
}

/// Mass of the grains between two diameters over the mass of all.
double mass_share(const std::vector<double>& diameters_m, double low_m, double high_m) {
  double in = 0, all = 0;
  for (const double d : diameters_m) {
    all += cube(d);
    if (d >= low_m && d < high_m) in += cube(d);
  }
  return in / all;
}

/// The largest overlap of any two grains, m; negative: the least gap. Periodic where asked.
double deepest_overlap_m(const BedSettings& bed, const std::vector<Grain>& grains) {
  double deepest = -1;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      Eigen::Vector3d d = grains[i].p_m - grains[j].p_m;
      if (bed.periodic_sides) {
        d.x() = std::remainder(d.x(), bed.box_length_m);
        d.y() = std::remainder(d.y(), bed.box_width_m);
      }
      deepest = std::max(deepest, grains[i].radius_m + grains[j].radius_m - d.norm());
    }
  }
  return deepest;
}

bool same_bits(const BedState& a, const BedState& b) {
  const std::vector<double> x = numbers(a), y = numbers(b);
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
}

}  // namespace

TEST_CASE("diameters hold the sieve's mass shares, uniform in diameter within a class") {
  BedSettings bed = paper_grains(0.1, 0.1, 0.1);
  bed.grain_scale = GENERATE(1.0, 3.6);
  const double s = bed.grain_scale;
  constexpr int kGrains = 20000;
  const std::vector<double> d = graded_diameters(bed, kGrains);
  REQUIRE(d.size() == kGrains);
  CHECK(std::is_sorted(d.begin(), d.end()));
  CHECK(d.front() >= s * 2e-3);
  CHECK(d.back() <= s * 6.4e-3);
  // Each share is off by at most about the mass of one grain of the largest size on each end:
  // (6.4 / 2.9)^3 = 11 mean grains of 20,000, 0.05 %.
  constexpr double kGrain = 6e-4;
  CHECK(mass_share(d, s * 2e-3, s * 4e-3) == Approx(0.5784).margin(kGrain));
  CHECK(mass_share(d, s * 4e-3, s * 6.5e-3) == Approx(0.4216).margin(kGrain));
  for (int fifth = 0; fifth < 5; ++fifth) {
    const double a = 2e-3 + 0.4e-3 * fifth, b = 4e-3 + 0.48e-3 * fifth;
    CHECK(mass_share(d, s * a, s * (a + 0.4e-3)) == Approx(0.5784 / 5).margin(kGrain));
    CHECK(mass_share(d, s * b, s * (b + 0.48e-3)) == Approx(0.4216 / 5).margin(kGrain));
  }
  // By hand: half of the mass is reached within the lower class.
  CHECK(bed.d50_m() == Approx(s * (2e-3 + 0.5 / 0.5784 * 2e-3)).epsilon(1e-12));
  CHECK(mass_share(d, 0, bed.d50_m()) == Approx(0.5).margin(kGrain));
}

TEST_CASE("diameters of one class are the quantiles of a number density like d^-3") {
  BedSettings bed = small_bed();
  const double a = 5e-3, b = 6e-3;
  const std::vector<double> d = graded_diameters(bed, 11);
  for (int i = 0; i < 11; ++i) {
    // N(d) = (a^-2 - d^-2) / (a^-2 - b^-2) at the middle of each eleventh.
    const double n = (1 / (a * a) - 1 / (d[i] * d[i])) / (1 / (a * a) - 1 / (b * b));
    CHECK(n == Approx((i + 0.5) / 11).epsilon(1e-10));
  }
}

TEST_CASE("d50 falls on either side of a class boundary") {
  BedSettings bed = small_bed();
  bed.grain_scale = 1;
  bed.sieve = {{1e-3, 2e-3, 0.25}, {2e-3, 4e-3, 0.75}};
  CHECK(bed.d50_m() == Approx(2e-3 + 0.25 / 0.75 * 2e-3));
  bed.sieve = {{1e-3, 2e-3, 0.5}, {3e-3, 4e-3, 0.5}};
  CHECK(bed.d50_m() == Approx(2e-3));
}

TEST_CASE("a bed of one size needs as many grains as its solids hold spheres") {
  BedSettings bed = small_bed();
  bed.sieve = {{2.5e-3, 2.5e-3 * (1 + 1e-6), 1.0}};
  bed.overfill = GENERATE(1.0, 1.25);
  const double spheres =
      0.6 * bed.overfill * 0.06 * 0.06 * 0.03 / (std::numbers::pi / 6 * cube(5e-3));
  CHECK(double(grains_to_pour(bed, 0.6)) == Approx(spheres).margin(0.6));
}

TEST_CASE("the paper's box takes the paper's number of grains") {
  // Ji et al., Actuators 2026, 15(6), 330: 933,059 grains fill 530 x 420 mm to 120 mm. The solid
  // share is not printed; 0.60 is that of poured sand, so 2 % is about its doubt.
  CHECK(double(grains_to_pour(paper_grains(0.53, 0.42, 0.12), 0.60)) ==
        Approx(933059).epsilon(0.02));
}

TEST_CASE("rain falls without overlaps and inside the box") {
  BedSettings bed = small_bed();
  bed.periodic_sides = GENERATE(false, true);
  const double column_m = 0.066;  // 30 % solids
  const std::vector<Grain> grains = rain(bed, column_m, 7);
  CHECK(grains.size() == grains_to_pour(bed, 0.60));
  CHECK(deepest_overlap_m(bed, grains) < 1e-15);  // rounding of the shift to the box's frame
  bool across = false;
  for (const Grain& g : grains) {
    const double side = bed.periodic_sides ? 0 : g.radius_m;
    REQUIRE(std::abs(g.p_m.x()) <= 0.030 - side + 1e-15);
    REQUIRE(std::abs(g.p_m.y()) <= 0.030 - side + 1e-15);
    REQUIRE(g.p_m.z() - g.radius_m >= -0.030 - 1e-15);
    REQUIRE(g.p_m.z() + g.radius_m <= -0.030 + column_m + 1e-15);
    across = across || std::abs(g.p_m.x()) > 0.030 - g.radius_m;
  }
  CHECK(across == bed.periodic_sides);
}

TEST_CASE("rain that cannot fit says so") {
  CHECK_THROWS_WITH(rain(small_bed(), 0.02, 1), Catch::Contains("bed: no room for grain"));
}

TEST_CASE("a made bed is level, at rest and as dense as poured grains") {
  BedSettings bed = small_bed();
  bed.periodic_sides = GENERATE(false, true);
  const BedState state = make_small_bed(bed);
  double weights_J = 0;  // of all grains, each lifted by its diameter
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    const Grain& g = state.grains[i];
    REQUIRE(g.id == i);
    REQUIRE(g.p_m.z() + g.radius_m <= 0);
    REQUIRE(g.p_m.z() > -0.030);
    weights_J += 2650 * std::numbers::pi / 6 * cube(2 * g.radius_m) * 9.81 * 2 * g.radius_m;
  }
  for (const GrainContact& c : state.contacts) {
    REQUIRE(c.i < state.grains.size());
    REQUIRE((c.j < state.grains.size() || c.j < GrainContact::kWallContact + 5));
    REQUIRE((c.j >= GrainContact::kWallContact) + (c.j < state.grains.size()) == 1);
  }
  const BedReport report = inspect_bed(bed, shipped_materials(), state);
  CHECK(report.grains == state.grains.size());
  // Single rattlers move; on the mean a grain's energy lifts it by under a thousandth of itself.
  CHECK(report.kinetic_energy_J < 1e-3 * weights_J);
  // Poured spheres fill 0.60 +- 0.02 (0.55 loose to 0.64 close). A flat wall keeps centres half a
  // grain away, which costs about 0.6 % of the share per wall in a box 11 grains wide and more at
  // the edges: measured 0.58 with the floor alone, 0.55 with four walls more.
  if (bed.periodic_sides) {
    CHECK(report.solid_share > 0.56);
    CHECK(report.solid_share < 0.64);
  } else {
    CHECK(report.solid_share > 0.53);
    CHECK(report.solid_share < 0.60);
  }
  // Frictional spheres rest with 4 to 6 partners; those at floor, walls and surface have fewer.
  CHECK(report.coordination_number > 3.5);
  CHECK(report.coordination_number < 6);
  // 52 grains in each of twelve regions.
  CHECK(report.largest_cell_deviation < 0.25);
}

TEST_CASE("a bed's report counts by hand") {
  BedSettings bed = small_bed();
  BedState state;
  state.grains = {{0, 2e-3, {0, 0, -0.015}, {0.1, 0, 0}, {0, 0, 0}},
                  {1, 1e-3, {0.01, 0.01, -0.003}, {0, 0, 0}, {0, 0, 0}}};
  state.contacts = {{0, 1, Eigen::Vector3d::Zero()},
                    {0, GrainContact::kWallContact, Eigen::Vector3d::Zero()}};
  const BedReport report = inspect_bed(bed, shipped_materials(), state);
  const double large_m3 = std::numbers::pi / 6 * cube(4e-3);
  const double small_m3 = std::numbers::pi / 6 * cube(2e-3);
  CHECK(report.solids_kg == Approx(2650 * (large_m3 + small_m3)));
  // The layer ends at -3 mm: all of the large grain and half of the small one.
  CHECK(report.solid_share == Approx((large_m3 + small_m3 / 2) / (0.06 * 0.06 * 0.024)));
  CHECK(report.coordination_number == Approx(1));
  CHECK(report.kinetic_energy_J == Approx(0.5 * 2650 * large_m3 * 0.01).epsilon(1e-6));
  CHECK(report.largest_cell_deviation == Approx(5));  // both in one of twelve, or one in each
}

TEST_CASE("a bed depends on its seed and on nothing else") {
  const BedSettings bed = small_bed();
  const BedState one = make_small_bed(bed, 5);
  CHECK(same_bits(one, make_small_bed(bed, 5)));
  CHECK(same_bits(one, make_small_bed(bed, 5, 2)));
  CHECK_FALSE(same_bits(one, make_small_bed(bed, 6)));
}

TEST_CASE("progress grows to one, and stops the making when it says so") {
  const BedSettings bed = small_bed();
  std::vector<double> shares;
  const BedProgress watch = [&shares](double share) {
    shares.push_back(share);
    return shares.size() < 100;
  };
  CHECK_THROWS_WITH(make_bed(bed, shipped_materials(), 1, 1, watch), "stopped");
  CHECK(shares.size() == 100);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.front() > 0);
  shares.clear();
  make_bed(bed, shipped_materials(), 1, 1, [&shares](double share) {
    shares.push_back(share);
    return true;
  });
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.back() == Approx(1));
}
