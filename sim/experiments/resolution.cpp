#include "sim/experiments/resolution.h"

#include <algorithm>
#include <cstdio>

namespace hoof::sim {
namespace {

// Provisional bounds, from first looks with another code at a 40 mm strip with spines 20 mm apart:
// on grains of d50 7.8 mm (2.1 times the paper's: pitch 2.6 d50, width 5.1 d50) spines changed the
// force by +86 % to -11 % with depth and the sole read 1.9 times too stiff; at the paper's own
// d50 of 3.7 mm (5.4 and 10.7) both effects were gone within the scatter of two beds. Sinkage of
// 5 mm (1.3 d50) scattered by a quarter there, of 8 mm (2.1 d50) by a twentieth.
constexpr double kSpinePitch_d50 = 5;
constexpr double kSoleWidth_d50 = 10;
constexpr double kSinkage_d50 = 2;
// A 30 mm plate in a box 4.6 times as wide read 29 % high at 8 mm against one 6.9 times as wide.
constexpr double kBox_foot = 5;

std::string line(const char* claim, const char* what, double ratio, double bound) {
  char text[240];
  std::snprintf(text, sizeof text, "%s: %s is %.3g, needs %.3g", claim, what, ratio, bound);
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
  r.claims_refused.push_back(
      "differences under 15 %: one bed preparation shows no scatter; repeat with --seed");
  return r;
}

}  // namespace hoof::sim
