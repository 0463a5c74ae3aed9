#include "sim/experiments/resolution.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hoof::sim {
namespace {

// Bounds from the studies of 2026-11-22, all with numbers in RESOLUTION.md beside this file.
// Spines 15 mm apart on grains of d50 5.6 mm changed the force as they did on the paper's of 3.7 mm
// once the sole was 1.4 d50 deep; before that a coarse bed shows too few grains to the sole.
constexpr double kSpinePitch_d50 = 2.6;
constexpr double kSpineSinkage_d50 = 1.4;
// Of a sole of 40 mm on the same grains, against the finest: within the error of 5 % where both
// hold.
constexpr double kSoleWidth_d50 = 7;
constexpr double kSinkage_d50 = 2;
// Walls: 2, 3, 4 times the foot read 38, 26, 10 % high 13 mm deep against 5 times.
constexpr double kBox_foot = 4;
// Floor: 1.1, 1.3, 2.0 widths of the foot below it read 2.6, 2.1, 1.3 times as high 13 mm deep as
// 2.6 widths, which themselves are not shown to be enough.
constexpr double kDepth_foot = 2.6;
// By its pitch the ends of a foot go 15 to 25 mm deeper than its middle
// (experiments/traction.toml); the passive wedge before a wall of that height is tan(45 + 37.8 / 2
// degrees) times as long (Rankine), the angle of repose for that of friction.
constexpr double kEndsDeeper_m = 0.025;
constexpr double kWedge = 2.04;

std::string line(const char* claim, const char* what, double ratio, double bound) {
  char text[240];
  std::snprintf(text, sizeof text, "%s: %s is %.3g, needs %.3g", claim, what, ratio, bound);
  return text;
}

std::string warning(const char* what, double size_m, double least_m, const char* effect) {
  char text[240];
  std::snprintf(text, sizeof text, "the box is small for this foot: %s = %.0f, should be %.0f; %s",
                what, size_m * 1e3, least_m * 1e3, effect);
  return text;
}

}  // namespace

Resolution assess_resolution(const BedSettings& bed, const FootGeometry& foot, double footprint_x_m,
                             double footprint_y_m, double sinkage_m) {
  Resolution r;
  const double d50 = bed.d50_m();
  const auto judge = [&](const char* claim, const char* what, double ratio, double bound) {
    if (ratio < bound) r.claims_refused.push_back(line(claim, what, ratio, bound));
  };
  if (foot.has_spines) {
    const SpineGeometry& s = foot.spines;
    r.spine_pitch_over_d50 = std::min(s.toe_pitch_m, s.middle_pitch_m / 2) / d50;
    judge("effect of the spines", "spine pitch / d50", *r.spine_pitch_over_d50, kSpinePitch_d50);
    judge("effect of the spines", "sinkage / d50", sinkage_m / d50, kSpineSinkage_d50);
  }
  if (foot.middle.width_m > 0) {
    r.sole_width_over_d50 = foot.middle.width_m / d50;
    judge("stiffness of the sand under the sole", "sole width / d50", *r.sole_width_over_d50,
          kSoleWidth_d50);
  }
  r.sinkage_over_d50 = sinkage_m / d50;
  judge("depth to better than a grain", "sinkage / d50", r.sinkage_over_d50, kSinkage_d50);
  r.box_length_over_foot = bed.box_length_m / footprint_x_m;
  r.box_width_over_foot = bed.box_width_m / footprint_y_m;
  judge("absolute forces and depths", "box / foot",
        std::min(r.box_length_over_foot, r.box_width_over_foot), kBox_foot);
  r.bed_depth_over_foot_width = bed.depth_m / std::min(footprint_x_m, footprint_y_m);
  judge("absolute forces and depths", "depth of the bed / width of the foot",
        r.bed_depth_over_foot_width, kDepth_foot);
  r.claims_refused.push_back(
      "differences under 15 %: one bed preparation shows no scatter; repeat with --seed");
  return r;
}

std::vector<std::string> box_warnings(const BedSettings& bed, double footprint_x_m,
                                      double footprint_y_m) {
  std::vector<std::string> lines;
  const auto check = [&](const char* what, double size_m, double least_m, const char* effect) {
    if (size_m < least_m) lines.push_back(warning(what, size_m, least_m, effect));
  };
  constexpr char kWalls[] = "forces read up to 40 % high at half of it, 13 mm deep";
  check("bed.box_length_mm", bed.box_length_m, kBox_foot * footprint_x_m, kWalls);
  check("bed.box_width_mm", bed.box_width_m, kBox_foot * footprint_y_m, kWalls);
  check("bed.depth_mm", bed.depth_m, kDepth_foot * std::min(footprint_x_m, footprint_y_m),
        "the floor makes forces read up to twice as high at half of it");
  return lines;
}

double least_length_m(const BedSettings& bed, double reach_m) {
  return 2 * (reach_m + bed.largest_diameter_m());
}

std::string wall_warning(const BedSettings& bed, double reach_m, const StanceEllipse& path) {
  const double depth_m = path.half_height_m - path.centre_height_m + kEndsDeeper_m;
  const double least_m = 2 * (reach_m + kWedge * std::max(0.0, depth_m));
  if (bed.periodic_sides || bed.box_length_m >= least_m) return "";
  return warning("bed.box_length_mm", bed.box_length_m, std::ceil(1e3 * least_m) / 1e3,
                 "the foot pushes sand against an end wall");
}

}  // namespace hoof::sim
