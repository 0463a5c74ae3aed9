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

bool same_bits(const BedState& a, const BedState& b) {
  const std::vector<double> x = numbers(a), y = numbers(b);
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
}

}  // namespace

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
  CHECK(report.largest_region_deviation < 0.25);
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

TEST_CASE("a making that goes on from a snapshot ends with the same bed") {
  BedSettings bed = small_bed();
  bed.periodic_sides = GENERATE(false, true);
  struct Kept {
    std::string stage, snapshot;
    std::uint64_t steps;
    double share;
  };
  std::vector<Kept> kept;  // the second of each stage: within it, not at its seam
  BedMaking undisturbed(bed, shipped_materials(), 3, 1);
  std::string stage;
  int pieces = 0;
  while (undisturbed.advance()) {
    pieces = undisturbed.stage_name() == stage ? pieces + 1 : 0;
    stage = undisturbed.stage_name();
    std::string snapshot = undisturbed.snapshot();
    if (pieces != 1 || snapshot.empty()) continue;
    kept.push_back({stage, std::move(snapshot), undisturbed.steps(), undisturbed.share_done()});
  }
  REQUIRE(kept.size() >= 3);
  for (const Kept& k : kept) {
    INFO("cut off while " << k.stage);
    BedMaking resumed(bed, shipped_materials(), 3, 2);
    resumed.restore(k.snapshot);
    CHECK(resumed.steps() == k.steps);
    CHECK(resumed.share_done() == k.share);
    CHECK((resumed.snapshot() == k.snapshot));
    while (resumed.advance()) {
    }
    CHECK(resumed.steps() == undisturbed.steps());
    CHECK(same_bits(resumed.bed(), undisturbed.bed()));
  }
  const std::string& last = kept.back().snapshot;
  BedMaking damaged(bed, shipped_materials(), 3, 1);
  CHECK_THROWS_WITH(damaged.restore(last.substr(0, last.size() - 1)), "is truncated");
  CHECK_THROWS_WITH(damaged.restore(last + "x"), "bed: the snapshot is too long");
}

TEST_CASE("a step that the smallest grain cannot follow is refused with what would do") {
  BedSettings bed = small_bed();
  // By hand, r = 2.5 mm: pi r sqrt(2650 / 71.4e6) / (0.1631 / 4 + 0.8766) = 52.2 us, of which 40 %
  // are 20.86 us: 47.9 steps in a millisecond.
  bed.settling_steps_per_ms = 47;
  CHECK_THROWS_WITH(BedMaking(bed, shipped_materials(), 1, 1),
                    Catch::StartsWith("bed.settling_steps_per_ms = 47: a step is ") &&
                        Catch::Contains("at most 40 %: at least 48"));
  bed.settling_steps_per_ms = 48;
  CHECK_NOTHROW(BedMaking(bed, shipped_materials(), 1, 1));
}
