// What the source paper printed of its four calibrations: Ji et al., Actuators 2026, 15(6), 330,
// tables 2, 4 and 5 (table 3 stands in tools/study/drop_law.h), its fits with the minus signs that
// print lost put back (only one pattern of signs fits the tables), and its measured values.
#pragma once

#include <array>
#include <vector>

namespace hoof::tools {

/// Table 2, a Box-Behnken plan of simulated heaps.
struct ReposeRow {
  double restitution, rolling_friction, static_friction;  // sand on sand
  double angle_deg;
};
const std::vector<ReposeRow>& paper_repose_table();
/// The paper's fit of it, minus signs put back, degrees.
double paper_repose_fit_deg(double restitution, double rolling_friction, double static_friction);

/// One value against one coefficient.
struct PaperRow {
  double x = 0;
  double y = 0;
};
/// Table 4: tilt angle in degrees at which the grain slides, over mu_s.
const std::vector<PaperRow>& paper_tilt_table();
/// Table 5: travel S2 in mm behind the incline, over mu_r.
const std::vector<PaperRow>& paper_roll_table();

/// A fit c[0] x^2 + c[1] x + c[2].
using Quadratic = std::array<double, 3>;
inline constexpr Quadratic kPaperDropFit_mm = {15.30, 39.02, 24.06};   // L over e
inline constexpr Quadratic kPaperTiltFit_deg = {-15.34, 61.00, 0.11};  // angle over mu_s
inline constexpr Quadratic kPaperRollFit_mm = {-4.29, -11.70, 37.04};  // S2 over mu_r

/// A measured value (75 grains each; repose: 8 heaps), and the simulated check of what was
/// calibrated from it.
struct PaperCheck {
  double measured = 0;
  double coefficient = 0;
  double check = 0;
};
inline constexpr PaperCheck kPaperDropCheck_mm = {50.92, 0.5636, 50.00};
inline constexpr PaperCheck kPaperTiltCheck_deg = {30.89, 0.5929, 31.07};
inline constexpr PaperCheck kPaperRollCheck_mm = {36.56, 0.0408, 36.29};
inline constexpr double kPaperReposeMeasured_deg = 37.8;
inline constexpr double kPaperReposeSimulated_deg = 38.25;
/// The paper's own difference of the two: what it takes for the same angle.
inline constexpr double kPaperReposeError_deg = 0.45;

// Not in the paper, recovered from its tables: one height of fall before and after the impact
// (+- 0.06 mm), with which table 3 is that of a frictionless plate; incline, run and fall with
// which table 5 is true rolling (40 to 55 degrees fit alike, so 45 was fixed).
inline constexpr double kPaperDropHeight_mm = 40.42;
inline constexpr double kPaperIncline_deg = 45;
inline constexpr double kPaperRollRun_mm = 49.6;
inline constexpr double kPaperRollFall_mm = 64.3;
inline constexpr double kPaperBin_mm = 4;
inline constexpr int kPaperGrains = 75;

}  // namespace hoof::tools
