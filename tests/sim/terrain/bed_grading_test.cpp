#include "sim/terrain/bed_grading.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

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
