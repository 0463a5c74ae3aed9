#include "sim/terrain/bed_key.h"

#include <catch2/catch.hpp>

#include "tests/sim/terrain/small_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

TEST_CASE("settings read back from a key give the same key") {
  BedSettings bed = paper_grains(0.1, 0.2 / 3, 0.1);
  bed.periodic_sides = GENERATE(false, true);
  bed.coulomb_cap = CoulombCap::kElasticNormal;
  bed.rolling_law = RollingLaw::kRelativeSpin;
  bed.precision = Precision::kDouble;
  bed.rain_share = 0.3;
  const std::uint64_t seed = 0xfedcba9876543210u;
  const std::string key = bed_key(bed, shipped_materials(), seed);
  const BedOrigin origin = parse_bed_key(key);
  CHECK(bed_key(origin.bed, origin.materials, origin.seed) == key);
  CHECK(origin.seed == seed);
  CHECK(origin.bed.periodic_sides == bed.periodic_sides);
  CHECK(origin.bed.box_width_m == bed.box_width_m);
  REQUIRE(origin.bed.sieve.size() == 2);
  CHECK(origin.bed.sieve[1].mass_share == 0.4216);
  CHECK(origin.bed.precision == Precision::kDouble);
  CHECK(origin.materials.sand_abs.static_friction.value == 0.5929);
}

TEST_CASE("what is no key of this recipe is told") {
  const std::string key = bed_key(small_bed(), shipped_materials(), 1);
  CHECK_THROWS_WITH(parse_bed_key("bread"), "says 'bread' where its recipe should be");
  CHECK_THROWS_WITH(parse_bed_key("recipe=1 seed=1"),
                    Catch::StartsWith("was made by recipe 1, this program has recipe "));
  CHECK_THROWS_WITH(parse_bed_key(key.substr(0, key.rfind(' '))),
                    "says '' where its mu_r should be");
  CHECK_THROWS_WITH(parse_bed_key(key + " salt=1"), "says more than this program knows");
}
