#include "sim/experiments/resolution.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace hoof::sim;

namespace {

constexpr double kFootX_m = 0.2, kFootY_m = 0.08;

/// d50 = 4 mm, so that lengths are easy multiples of it.
BedSettings bed_of_4_mm() {
  BedSettings bed;
  bed.sieve = {{3e-3, 5e-3, 1.0}};
  bed.box_length_m = 20 * kFootX_m;
  bed.box_width_m = 20 * kFootY_m;
  bed.depth_m = 0.1;
  return bed;
}

/// Every length far above its bound.
FootGeometry fine_foot() {
  FootGeometry foot;
  foot.middle.width_m = 0.2;
  foot.has_spines = true;
  foot.spines.toe_pitch_m = 0.1;
  foot.spines.middle_pitch_m = 0.3;
  return foot;
}

Resolution assess(const BedSettings& bed, const FootGeometry& foot, double sinkage_m = 0.1) {
  return assess_resolution(bed, foot, kFootX_m, kFootY_m, sinkage_m);
}

bool refuses(const Resolution& r, const std::string& claim) {
  return std::any_of(r.claims_refused.begin(), r.claims_refused.end(),
                     [&claim](const std::string& line) { return line.rfind(claim, 0) == 0; });
}

constexpr char kSpines[] = "effect of the spines: spine pitch / d50 is ";
constexpr char kSole[] = "stiffness of the sand under the sole: sole width / d50 is ";
constexpr char kDepth[] = "depth to better than a grain: sinkage / d50 is ";
constexpr char kBox[] = "absolute forces and depths: box / foot is ";

}  // namespace

TEST_CASE("ratios of lengths over the grain and of the box over the foot") {
  BedSettings bed = bed_of_4_mm();
  bed.grain_scale = GENERATE(1.0, 2.0);
  const Resolution r = assess(bed, fine_foot());
  const double d50_m = 4e-3 * bed.grain_scale;
  REQUIRE(r.spine_pitch_over_d50);
  CHECK(*r.spine_pitch_over_d50 == Approx(0.1 / d50_m));
  REQUIRE(r.sole_width_over_d50);
  CHECK(*r.sole_width_over_d50 == Approx(0.2 / d50_m));
  CHECK(r.sinkage_over_d50 == Approx(0.1 / d50_m));
  CHECK(r.box_length_over_foot == Approx(20));
  CHECK(r.box_width_over_foot == Approx(20));
}

TEST_CASE("the nearest spines count: two staggered rows are half a pitch apart") {
  FootGeometry foot = fine_foot();
  foot.spines.middle_pitch_m = 0.1;
  CHECK(*assess(bed_of_4_mm(), foot).spine_pitch_over_d50 == Approx(0.05 / 4e-3));
}

TEST_CASE("what resolves everything still refuses small differences: one bed shows no scatter") {
  const Resolution r = assess(bed_of_4_mm(), fine_foot());
  REQUIRE(r.claims_refused.size() == 1);
  CHECK(refuses(r, "differences under 15 %"));
}

TEST_CASE("each claim is refused just below its bound and stands just above") {
  const double share = GENERATE(0.98, 1.02);
  const bool refused = share < 1;
  const double d50_m = 4e-3;

  FootGeometry foot = fine_foot();
  foot.spines.toe_pitch_m = 5 * d50_m * share;
  CHECK(refuses(assess(bed_of_4_mm(), foot), kSpines) == refused);

  foot = fine_foot();
  foot.middle.width_m = 10 * d50_m * share;
  CHECK(refuses(assess(bed_of_4_mm(), foot), kSole) == refused);

  CHECK(refuses(assess(bed_of_4_mm(), fine_foot(), 2 * d50_m * share), kDepth) == refused);

  BedSettings narrow = bed_of_4_mm();
  narrow.box_length_m = 5 * kFootX_m * share;
  CHECK(refuses(assess(narrow, fine_foot()), kBox) == refused);
  narrow = bed_of_4_mm();
  narrow.box_width_m = 5 * kFootY_m * share;
  CHECK(refuses(assess(narrow, fine_foot()), kBox) == refused);
}

TEST_CASE("a refused claim names its ratio and its bound") {
  FootGeometry foot = fine_foot();
  foot.middle.width_m = 0.02;
  const Resolution r = assess(bed_of_4_mm(), foot);
  CHECK(r.claims_refused.front() ==
        "stiffness of the sand under the sole: sole width / d50 is 5, needs 10");
}

TEST_CASE("a foot without spines or of unknown lengths makes no claim about them") {
  const Resolution r = assess(bed_of_4_mm(), FootGeometry{});
  CHECK_FALSE(r.spine_pitch_over_d50);
  CHECK_FALSE(r.sole_width_over_d50);
  CHECK(r.claims_refused.size() == 1);
}
