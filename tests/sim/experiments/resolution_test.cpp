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
  bed.depth_m = 10 * kFootY_m;
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
constexpr char kSpineDepth[] = "effect of the spines: sinkage / d50 is ";
constexpr char kSole[] = "stiffness of the sand under the sole: sole width / d50 is ";
constexpr char kDepth[] = "depth to better than a grain: sinkage / d50 is ";
constexpr char kFloor[] = "absolute forces and depths: depth of the bed / width of the foot is ";
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
  CHECK(r.bed_depth_over_foot_width == Approx(10));
}

TEST_CASE("the width of a foot is its shorter side, whichever way it stands") {
  const Resolution along = assess_resolution(bed_of_4_mm(), fine_foot(), 0.2, 0.08, 0.1);
  const Resolution across = assess_resolution(bed_of_4_mm(), fine_foot(), 0.08, 0.2, 0.1);
  CHECK(along.bed_depth_over_foot_width == across.bed_depth_over_foot_width);
}

TEST_CASE("a box too small for the foot is named before the run, with key and bound") {
  CHECK(box_warnings(bed_of_4_mm(), kFootX_m, kFootY_m).empty());
  BedSettings bed = bed_of_4_mm();
  bed.box_length_m = 0.5, bed.box_width_m = 0.3, bed.depth_m = 0.12;
  const std::vector<std::string> lines = box_warnings(bed, kFootX_m, kFootY_m);
  REQUIRE(lines.size() == 3);
  CHECK_THAT(lines[0], Catch::StartsWith("the box is small for this foot: bed.box_length_mm = 500, "
                                         "should be 800; "));
  CHECK_THAT(lines[1], Catch::Contains("bed.box_width_mm = 300, should be 320"));
  CHECK_THAT(lines[2], Catch::Contains("bed.depth_mm = 120, should be 208"));
  bed.box_length_m = 4.001 * kFootX_m, bed.box_width_m = 4.001 * kFootY_m;
  CHECK(box_warnings(bed, kFootX_m, kFootY_m).size() == 1);
}

TEST_CASE(
    "a pulled foot needs a grain's width before each end wall, and a wedge's to be undisturbed") {
  BedSettings bed = bed_of_4_mm();
  const double reach_m = 0.18, grain_m = bed.largest_diameter_m();
  CHECK(least_length_m(bed, reach_m) == Approx(2 * (0.18 + grain_m)));
  // The middle 5 mm deep, the ends 30: 61 mm of wedge, 2 x (180 + 61.2).
  const StanceEllipse path{.half_length_m = 0.1, .half_height_m = 0.02, .centre_height_m = 0.015};
  bed.box_length_m = 0.482;
  CHECK_THAT(wall_warning(bed, reach_m, path),
             Catch::StartsWith("the box is small for this foot: bed.box_length_mm = 482, should be "
                               "483; the foot pushes sand against an end wall"));
  bed.box_length_m = 0.483;
  CHECK(wall_warning(bed, reach_m, path) == "");
  const StanceEllipse deeper{.half_length_m = 0.1, .half_height_m = 0.02, .centre_height_m = 0.014};
  CHECK(wall_warning(bed, reach_m, deeper) != "");
  bed.periodic_sides = true;  // no wall
  CHECK(wall_warning(bed, reach_m, deeper) == "");
  // In the air all the way: only the reach itself counts.
  const StanceEllipse high{.half_length_m = 0.1, .half_height_m = 0.02, .centre_height_m = 0.1};
  bed.periodic_sides = false, bed.box_length_m = 0.361;
  CHECK(wall_warning(bed, reach_m, high) == "");
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
  foot.spines.toe_pitch_m = 2.6 * d50_m * share;
  CHECK(refuses(assess(bed_of_4_mm(), foot), kSpines) == refused);

  CHECK(refuses(assess(bed_of_4_mm(), fine_foot(), 1.4 * d50_m * share), kSpineDepth) == refused);

  foot = fine_foot();
  foot.middle.width_m = 7 * d50_m * share;
  CHECK(refuses(assess(bed_of_4_mm(), foot), kSole) == refused);

  CHECK(refuses(assess(bed_of_4_mm(), fine_foot(), 2 * d50_m * share), kDepth) == refused);

  BedSettings narrow = bed_of_4_mm();
  narrow.box_length_m = 4 * kFootX_m * share;
  CHECK(refuses(assess(narrow, fine_foot()), kBox) == refused);
  narrow = bed_of_4_mm();
  narrow.box_width_m = 4 * kFootY_m * share;
  CHECK(refuses(assess(narrow, fine_foot()), kBox) == refused);

  BedSettings shallow = bed_of_4_mm();
  shallow.depth_m = 2.6 * kFootY_m * share;
  CHECK(refuses(assess(shallow, fine_foot()), kFloor) == refused);
}

TEST_CASE("a refused claim names its ratio and its bound") {
  FootGeometry foot = fine_foot();
  foot.middle.width_m = 0.02;
  const Resolution r = assess(bed_of_4_mm(), foot);
  CHECK(r.claims_refused.front() ==
        "stiffness of the sand under the sole: sole width / d50 is 5, needs 7");
}

TEST_CASE("a foot without spines or of unknown lengths makes no claim about them") {
  const Resolution r = assess(bed_of_4_mm(), FootGeometry{});
  CHECK_FALSE(r.spine_pitch_over_d50);
  CHECK_FALSE(r.sole_width_over_d50);
  CHECK(r.claims_refused.size() == 1);
}
