#include "sim/terrain/bed_report.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "tests/sim/terrain/small_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

double cube(double x) {
  return x * x * x;
}

}  // namespace

TEST_CASE("a bed's report counts by hand") {
  BedSettings bed = small_bed();
  bed.sieve = {{0.9e-3, 1.5e-3, 0.5}, {1.5e-3, 2e-3, 0.5}};  // times 2: the scale
  BedState state;
  // Two grains in the middle that overlap by 20 um, one that reaches the floor by 10 um, and one
  // through whose middle the upper tenth begins.
  state.grains = {{0, 2e-3, {0.001, 0.001, -0.015}, {0.1, 0, 0}, {0, 0, 0}},
                  {1, 1e-3, {0.001, 0.001, -0.015 + 3e-3 - 20e-6}, {0, 0, 0}, {0, 0, 50}},
                  {2, 2e-3, {-0.01, -0.02, -0.030 + 2e-3 - 10e-6}, {0, 0, 0}, {0, 0, 0}},
                  {3, 1e-3, {0.01, 0.02, -0.003}, {0, 0, 0}, {0, 0, 0}}};
  state.contacts = {{0, 1, Eigen::Vector3d::Zero()},
                    {0, 3, Eigen::Vector3d::Zero()},  // touched once, apart by now
                    {2, GrainContact::kWallContact, Eigen::Vector3d::Zero()}};
  const BedReport report = inspect_bed(bed, shipped_materials(), state);
  const double large_m3 = std::numbers::pi / 6 * cube(4e-3);
  const double small_m3 = std::numbers::pi / 6 * cube(2e-3);
  CHECK(report.grains == 4);
  CHECK(report.solids_kg == Approx(2650 * 2 * (large_m3 + small_m3)));

  // The layer of the solid share is -27 to -3 mm: the first two grains, half of the last, and of
  // the one on the floor the cap of 0.99 mm (top at -26.01 mm), pi/3 h^2 (3 r - h).
  const double cap_m3 = std::numbers::pi / 3 * 0.99e-3 * 0.99e-3 * (6e-3 - 0.99e-3);
  const double area_m2 = 0.06 * 0.06;
  CHECK(report.solid_share == Approx((large_m3 + 1.5 * small_m3 + cap_m3) / (area_m2 * 0.024)));
  // Ten layers of 3 mm: the fifth and sixth meet in the middle of grain 0, the last two in that of
  // grain 3.
  CHECK(report.layer_solid_share[0] * area_m2 * 0.003 ==
        Approx(large_m3 - cap_m3 - std::numbers::pi / 3 * 1e-10 * (6e-3 - 1e-5)));
  CHECK(report.layer_solid_share[4] * area_m2 * 0.003 == Approx(large_m3 / 2));
  CHECK(report.layer_solid_share[9] * area_m2 * 0.003 == Approx(small_m3 / 2));

  // One pair of four grains; walls are no partners, those apart do not touch.
  CHECK(report.coordination_number == Approx(0.5));
  CHECK(report.largest_overlap_ratio == Approx(20e-6 / 1e-3));
  // 1/2 m v^2, and 1/2 (2/5 m r^2) w^2.
  const double energy_J = 0.5 * 2650 * (large_m3 * 0.01 + 0.4 * small_m3 * 1e-6 * 2500);
  CHECK(report.kinetic_energy_J == Approx(energy_J));
  CHECK(report.energy_ratio ==
        Approx(energy_J / (2650 * 9.81 * 2 * (large_m3 * 4e-3 + small_m3 * 2e-3))));
  CHECK(report.highest_grain_m == Approx(-2e-3));
  // Columns of 15 mm, rows of 20: the first two grains share a region, the others have their own.
  CHECK(report.region_grains == std::array<std::size_t, 12>{0, 1, 0, 0, 0, 0, 2, 0, 0, 0, 1, 0});
  CHECK(report.largest_region_deviation == Approx(5));  // 2 where 1/3 is the mean
  REQUIRE(report.graded_share.size() == 2);
  CHECK(report.graded_share[0] == Approx(small_m3 / (small_m3 + large_m3)));
  CHECK(report.graded_share[1] == Approx(large_m3 / (small_m3 + large_m3)));
}
