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
