#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "tools/calibrate/lab_formulas.h"
#include "tools/calibrate/lab_text.h"
#include "tools/calibrate/reduction.h"
#include "tools/calibrate/single_grain.h"

namespace hoof::tools {
namespace {

sim::Materials with(sim::Materials m, double mu_r) {
  m.sand_abs.rolling_friction.value = mu_r;
  return m;
}

struct Sweep {
  std::vector<RollOutcome> out;
  std::vector<PaperRow> ours, no_spin;  // S2 in mm over mu_r
};

Sweep sweep(const sim::Materials& materials, const RollTest& test, const LabProgress& progress) {
  Sweep s;
  const auto& table = paper_roll_table();
  for (const PaperRow& row : table) {
    tell(progress, double(s.out.size()) / double(table.size() + 2), text("mu_r = %.3f", row.x));
    s.out.push_back(roll(with(materials, row.x), test));
    s.ours.push_back({row.x, 1e3 * s.out.back().travel_m.front()});
    s.no_spin.push_back(
        {row.x, 1e3 * roll_travel_m(test.incline_rad, test.run_m, test.fall_m, row.x, 0)});
  }
  return s;
}

/// Largest |ours - the paper's| over the table.
double worst_miss_mm(const std::vector<PaperRow>& ours) {
  double worst = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    worst = std::max(worst, std::abs(ours[i].y - paper_roll_table()[i].y));
  }
  return worst;
}

/// Speed at the edge against the balance with the spin energy, worst, in per cent.
double speed_error_percent(const Sweep& s, const RollTest& test) {
  double worst = 0;
  for (std::size_t i = 0; i < s.out.size(); ++i) {
    const double a = rolling_acceleration_m_s2(test.incline_rad, s.ours[i].x);
    const double v = std::sqrt(2 * a * test.run_m);
    worst = std::max(worst, 100 * std::abs(s.out[i].edge_speed_m_s / v - 1));
  }
  return worst;
}

Table runs_table(const Sweep& s) {
  Table table({{"rolling_friction_ratio", 3},
               {"paper_travel_mm", 2},
               {"travel_mm", 4},
               {"no_spin_travel_mm", 4},
               {"edge_speed_m_s", 5},
               {"rim_speed_ratio", 5}});
  for (std::size_t i = 0; i < s.out.size(); ++i) {
    table.row({s.ours[i].x, paper_roll_table()[i].y, s.ours[i].y, s.no_spin[i].y,
               s.out[i].edge_speed_m_s, s.out[i].rim_share});
  }
  return table;
}

/// Rolling friction by a balance; NaN where none gives the travel.
double by_balance(double travel_mm, const RollTest& t, double inertia) {
  try {
    return rolling_friction_of(1e-3 * travel_mm, t.incline_rad, t.run_m, t.fall_m, inertia);
  } catch (const std::invalid_argument&) {
    return std::nan("");
  }
}

void add_readings(Findings& f, const Sweep& s, const RollTest& test, double bin_mm, int grains) {
  const double measured = kPaperRollCheck_mm.measured;
  const Quadratic ours = fit_quadratic(s.ours);
  const double slope = 2 * ours[0] * kPaperRollCheck_mm.coefficient + ours[1];
  const double doubt = bin_mm / std::sqrt(12.0) / std::sqrt(double(grains)) / std::abs(slope);
  f.readings_of = text("rolling friction from the measured S2 = %.2f mm", measured);
  f.readings = {
      {"paper: its fit of table 5", root_of(kPaperRollFit_mm, measured, 0, 0.3),
       "a fit of simulated runs has the spin in it; it stands whatever the balance says"},
      {"paper: m g (H3 - mu_r S1 cos) = m v^2 / 2", by_balance(measured, test, 0),
       "wrong: it leaves out the spin, 2/7 of a rolling sphere's energy; the friction has to eat "
       "it"},
      {"balance with spin, 7/5", by_balance(measured, test, kSolidSphere),
       "v^2 = 10/7 g S1 (sin - mu_r cos) at this run and fall"},
      {"grains", root_of(ours, measured, 0, 0.3),
       text("bins of %.0f mm leave +- %.3f of %d grains that scatter over several bins, up to "
            "+- %.2f of grains that all fall into one",
            bin_mm, doubt, grains, 0.5 * bin_mm / std::abs(slope))}};
}

}  // namespace

Findings find_rolling(const sim::Materials& materials, const RollingSettings& settings,
                      const LabProgress& progress) {
  const RollTest& test = settings.test;
  require_rolling(materials, test);
  const double mu_r = materials.sand_abs.rolling_friction.value;
  const double degrees = test.incline_rad * 180 / std::numbers::pi;
  const Sweep s = sweep(materials, test, progress);
  RollTest many = test;
  many.grains = settings.check.grains;
  many.spread_m = settings.check.spread_m;
  many.seed = settings.check.seed;
  tell(progress, 0.85, text("%d grains", many.grains));
  const auto landed_mm = in_mm(roll(materials, many).travel_m);
  const double bin_mm = 1e3 * settings.check.bin_m;
  double rim_low = 2, rim_high = 0;
  for (const RollOutcome& out : s.out) {
    rim_low = std::min(rim_low, out.rim_share), rim_high = std::max(rim_high, out.rim_share);
  }

  Findings f;
  f.laboratory = "rolling";
  f.title = "Rolling: a grain rolls down an incline, leaves its edge and lands";
  f.about = {text("A 4 mm grain rolls S1 = %.1f mm from rest down an incline of %.1f degrees and "
                  "lands H4 = %.1f mm below the edge, S2 behind it (centre to centre), once for "
                  "each mu_r of table 5.",
                  1e3 * test.run_m, degrees, 1e3 * test.fall_m),
             text("The check: %d grains of the paper's sizes at mu_r = %.4f, released within "
                  "+- %.1f mm; weighted mean over bins of %.1f mm.",
                  many.grains, mu_r, 1e3 * many.spread_m, bin_mm)};
  f.targets = {
      {"S2(mu_r), largest difference to table 5", "mm", {}, {}, 0.4, worst_miss_mm(s.ours), 3},
      {"edge speed, largest error to rolling without slip",
       "%",
       {},
       {},
       1.0,
       speed_error_percent(s, test),
       3},
      {"rim speed over edge speed, least", "", {}, {}, {}, rim_low, 4},
      {"rim speed over edge speed, most", "", {}, {}, {}, rim_high, 4},
      {"S2 by the paper's balance, largest difference to table 5",
       "mm",
       {},
       {},
       {},
       worst_miss_mm(s.no_spin),
       2},
      {text("S2 at mu_r = %.4f, binned mean", mu_r),
       "mm",
       kPaperRollCheck_mm.check,
       {},
       {},
       binned_mean(landed_mm, bin_mm),
       2},
      {text("S2 at mu_r = %.4f, plain mean", mu_r), "mm", {}, {}, {}, mean_of(landed_mm), 2}};
  add_readings(f, s, test, bin_mm, many.grains);
  f.notes = {
      bins_text(landed_mm, bin_mm),
      "The paper gives neither incline nor lengths. 45 degrees was fixed, S1 and H4 fitted to "
      "table "
      "5 (40 to 55 degrees fit alike): the band tests the shape of S2(mu_r). With the paper's "
      "balance S1 = 35.4 mm fits as well, so the table cannot tell the two; a ruler can.",
      text("To roll without slip at mu_r = %.2f this incline needs mu_s = %.3f at least.",
           paper_roll_table().back().x,
           friction_to_roll(test.incline_rad, paper_roll_table().back().x))};
  f.x_label = "rolling friction mu_r";
  f.y_label = "S2, mm";
  f.lines = {marks("table 5 of the paper", paper_roll_table(), 6), line("grains", s.ours, 0),
             dashed("balance without spin (paper)", s.no_spin, 3)};
  f.runs = runs_table(s);
  return f;
}

}  // namespace hoof::tools
