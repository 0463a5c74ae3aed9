#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tools/calibrate/lab_text.h"
#include "tools/calibrate/reduction.h"
#include "tools/calibrate/single_grain.h"

namespace hoof::tools {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;  // in a radian

sim::Materials with(sim::Materials m, double mu_s) {
  m.sand_abs.static_friction.value = mu_s;
  return m;
}

struct Sweep {
  std::vector<PaperRow> seen, onset, coulomb;  // degrees over mu_s
};

Sweep sweep(const sim::Materials& materials, const TiltTest& test, const LabProgress& progress) {
  Sweep s;
  const auto& table = paper_tilt_table();
  for (const PaperRow& row : table) {
    tell(progress, double(s.seen.size()) / double(table.size() + 2), text("mu_s = %.3f", row.x));
    const TiltOutcome out = tilt_in_two(with(materials, row.x), test);
    s.seen.push_back({row.x, kDegrees * out.seen_rad.front()});
    s.onset.push_back({row.x, kDegrees * out.onset_rad.front()});
    s.coulomb.push_back({row.x, kDegrees * std::atan(row.x)});
  }
  return s;
}

double worst_between(const std::vector<PaperRow>& a, const std::vector<PaperRow>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i].y - b[i].y));
  return worst;
}

double mean_between(const std::vector<PaperRow>& a, const std::vector<PaperRow>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].y - b[i].y;
  return sum / double(a.size());
}

Table runs_table(const Sweep& s) {
  Table table({{"static_friction_ratio", 3},
               {"paper_tilt_deg", 2},
               {"seen_tilt_deg", 4},
               {"onset_tilt_deg", 4},
               {"atan_mu_s_deg", 4}});
  for (std::size_t i = 0; i < s.seen.size(); ++i) {
    table.row({s.seen[i].x, paper_tilt_table()[i].y, s.seen[i].y, s.onset[i].y, s.coulomb[i].y});
  }
  return table;
}

void add_readings(Findings& f, const Sweep& s, const TiltTest& test) {
  const double measured = kPaperTiltCheck_deg.measured;
  f.readings_of = text("static friction from the measured tilt of %.2f degrees", measured);
  f.readings = {
      {"paper: its fit of table 4", root_of(kPaperTiltFit_deg, measured, 0.3, 0.7),
       text("takes over the table's own lag: it lies %.2f degrees above atan(mu_s) in the mean",
            mean_between(paper_tilt_table(), s.coulomb))},
      {"tan of the tilt", std::tan(measured / kDegrees),
       "Coulomb's law, for a tilt read as sliding begins"},
      {"grains, tilt at the onset", root_of(fit_quadratic(s.onset), measured, 0.3, 0.7),
       "slide followed back to zero: tan of the tilt again"},
      {text("grains, tilt when seen to slide (%g mm)", 1e3 * test.seen_m),
       root_of(fit_quadratic(s.seen), measured, 0.3, 0.7),
       text("tilted at %g degrees a second the plate is late by %.2f degrees in the mean",
            kDegrees * test.rate_rad_s, mean_between(s.seen, s.coulomb))}};
}

}  // namespace

Findings find_sliding(const sim::Materials& materials, const SlidingSettings& settings,
                      const LabProgress& progress) {
  const TiltTest& test = settings.test;
  test.validate();
  const double mu_s = materials.sand_abs.static_friction.value;
  const Sweep s = sweep(materials, test, progress);
  TiltTest many = test;
  many.grains = settings.grains;
  tell(progress, 0.9, text("%d grains", many.grains));
  const TiltOutcome check = tilt_in_two(materials, many);
  const auto [low, high] = std::minmax_element(check.seen_rad.begin(), check.seen_rad.end());

  Findings f;
  f.laboratory = "sliding";
  f.title = "Sliding: a plate is tilted until a grain on it slides";
  f.about = {
      text("A 4 mm grain whose rotation is held lies on a plate that is tilted by %g degrees a "
           "second, once for each mu_s of table 4. It is seen to slide at %g mm.",
           kDegrees * test.rate_rad_s, 1e3 * test.seen_m),
      text("The check: %d grains of the paper's sizes, each alone, at mu_s = %.4f.", many.grains,
           mu_s)};
  f.targets = {{"tilt when seen to slide, largest difference to table 4",
                "deg",
                {},
                {},
                0.4,
                worst_between(s.seen, paper_tilt_table()),
                3},
               {"tilt at the onset, largest difference to table 4",
                "deg",
                {},
                {},
                0.4,
                worst_between(s.onset, paper_tilt_table()),
                3},
               // 1 % of the table's own distance from atan(mu_s), and what its two digits can show.
               {"tilt at the onset, largest difference to atan(mu_s)",
                "deg",
                {},
                {},
                0.005,
                worst_between(s.onset, s.coulomb),
                4},
               {text("tilt when seen to slide at mu_s = %.4f, mean", mu_s),
                "deg",
                kPaperTiltCheck_deg.check,
                {},
                {},
                kDegrees * mean_of(check.seen_rad),
                2},
               {"the same, spread over grains of 2 to 6.4 mm",
                "deg",
                {},
                {},
                {},
                kDegrees * (*high - *low),
                5}};
  add_readings(f, s, test);
  f.notes = {
      "A free sphere rolls at atan(mu_r), 2.3 degrees here: the paper's tilt test must have held "
      "its rotation, which it does not say. Here no torque turns the grain.",
      "The paper states neither rate of tilt nor what counts as sliding. Any pair of them with the "
      "same lag explains its 0.25 degrees; the lag grows with the rate to the power 2/3."};
  f.x_label = "static friction mu_s";
  f.y_label = "tilt, degrees";
  f.lines = {marks("table 4 of the paper", paper_tilt_table(), 6),
             line("grains, when seen to slide", s.seen, 0), line("grains, onset", s.onset, 1),
             dashed("atan(mu_s)", s.coulomb, 2)};
  f.runs = runs_table(s);
  return f;
}

}  // namespace hoof::tools
