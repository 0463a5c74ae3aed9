#include "sim/terrain/bed_rain.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/terrain/small_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

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

}  // namespace

TEST_CASE("rain falls without overlaps and inside the box") {
  BedSettings bed = small_bed();
  bed.periodic_sides = GENERATE(false, true);
  const double column_m = 0.066;  // 30 % solids
  Rain rain(bed, column_m, 7);
  while (rain.pour(100)) {
  }
  const std::vector<Grain>& grains = rain.grains();
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
  Rain rain(small_bed(), 0.02, 1);
  CHECK_THROWS_WITH(rain.pour(1000), Catch::Contains("bed: no room for grain"));
}
