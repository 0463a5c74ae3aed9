// The drop test of the source paper: a grain falls on a plate at 45 degrees and lands L away. Which
// law of L over e fits the simulated table, and does the one with retained tangential speed?
//
// Symbol   Meaning                                                                    Unit
// e        coefficient of restitution, the kept share of normal speed                 1
// k_t      kept share of tangential speed                                             1
// H        height of fall onto the plate; H2: from the plate to the ground below      m
// v_0      speed of the impact, v_0^2 = 2 g H                                         m/s
// v_x v_z  speed after it, horizontal and upward                                      m/s
// L        horizontal travel                                                          m
//
// At 45 degrees normal and tangent have v_0 / sqrt 2 each before the impact, hence after it
//   v_x = v_0 (e + k_t) / 2,  v_z = v_0 (e - k_t) / 2 = v_0 a,
// and with the time of flight (v_z + sqrt(v_z^2 + 2 g H2)) / g
//   L = (e + k_t) H (a + sqrt(a^2 + H2/H)),  a = (e - k_t) / 2.
// L = 2 e H is this with k_t = e and H2 = H: an impact after which the grain flies off level.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace hoof::tools {

/// L for the heights before and after the impact, in the unit of the heights.
double drop_travel(double e, double kept_tangential, double height, double height_after);

struct DropRow {
  double e = 0;
  double travel_mm = 0;
};

/// Ji et al.: Actuators 15 (2026) 330, table 3: simulated drops of one grain.
const std::vector<DropRow>& paper_drop_table();

struct DropParameter {
  std::string name;
  double start = 0;
};

struct DropLaw {
  std::string name;
  std::vector<DropParameter> parameters;  // heights in mm
  std::function<double(double e, std::span<const double> values)> travel_mm;
};

/// What the paper has, what it left out, rivals, and a free curve as the floor.
const std::vector<DropLaw>& drop_laws();
constexpr std::size_t kPaperLaw = 0;
constexpr std::size_t kRetainedLaw = 1;
constexpr std::size_t kRetainedTwoHeightsLaw = 2;
constexpr std::size_t kOffsetLaw = 6;
constexpr std::size_t kFreeCurve = 7;

struct DropFit {
  std::vector<double> values;       // of the law's parameters
  std::vector<double> interval;     // half of the 95 % interval (Student's t)
  double rms_mm = 0;                // over the rows it was fitted to
  std::vector<double> held_out_mm;  // by row: fitted to the others, predicted less the table's
  double held_out_rms_mm = 0;
};

/// Least squares over all rows, and again without each row in turn.
DropFit fit_drop_law(const DropLaw& law, const std::vector<DropRow>& rows);

/// Prints the laws, and the paper's and the retained one row by row. Writes laws.csv and rows.csv
/// to `out` unless it is empty. @throws UserError where they cannot be written
void run_drop_law_study(const std::string& out);

}  // namespace hoof::tools
