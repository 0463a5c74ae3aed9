#include "tools/calibrate/repose_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "sim/terrain/random.h"
#include "tools/calibrate/lab_text.h"
#include "tools/calibrate/reduction.h"
#include "tools/design_of_experiments/anova_report.h"
#include "tools/study/statistics.h"

namespace hoof::tools {
namespace {

constexpr int kDraws = 2000;
constexpr std::size_t kLeastRows = 3;

/// Mean of the paper's angles of one combination.
double paper_angle_deg(const ReposeRow& of) {
  std::vector<double> angles;
  for (const ReposeRow& row : paper_repose_table()) {
    if (row.restitution == of.restitution && row.rolling_friction == of.rolling_friction &&
        row.static_friction == of.static_friction) {
      angles.push_back(row.angle_deg);
    }
  }
  return mean_of(angles);
}

/// To a hundredth, so that no bits of a conversion are in the file.
double rounded(double value) {
  return std::round(100 * value) / 100;
}

/// Rows of which at least one heap told an angle.
struct Told {
  std::vector<double> paper, ours;
  std::vector<std::vector<double>> heaps;
  std::size_t heaps_told = 0;
};

std::string with_band(const std::string& name, const Told& told, Correlation of) {
  const CorrelationBand band = correlation_band(told.paper, told.heaps, of);
  return name + text(" (95 %% of re-drawn rows and heaps: %.2f to %.2f)", band.low, band.high);
}

void add_targets(Findings& f, const Told& told, std::size_t rows, std::size_t heaps) {
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < told.ours.size(); ++i) {
    squares += std::pow(told.ours[i] - told.paper[i], 2);
    sum += told.ours[i] - told.paper[i];
  }
  const double n = double(told.ours.size());
  const std::string of = text("table 2, %d of its %d combinations: ", int(n), int(rows));
  f.targets.push_back(
      {of + "rms of the differences", "deg", {}, {}, {}, std::sqrt(squares / n), 2});
  f.targets.push_back({of + "mean difference", "deg", {}, {}, {}, sum / n, 2});
  f.targets.push_back({with_band(of + "Spearman's rank correlation", told, rank_correlation),
                       "",
                       {},
                       {},
                       {},
                       rank_correlation(told.paper, told.ours),
                       3});
  f.targets.push_back({with_band(of + "Kendall's rank correlation", told, kendall_correlation),
                       "",
                       {},
                       {},
                       {},
                       kendall_correlation(told.paper, told.ours),
                       3});
  f.targets.push_back({text("table 2: heaps that tell an angle, of %d", int(heaps)),
                       "",
                       {},
                       {},
                       {},
                       double(told.heaps_told),
                       0});
}

void plot(Findings& f, const Told& told) {
  std::vector<PaperRow> points;
  for (std::size_t i = 0; i < told.ours.size(); ++i)
    points.push_back({told.paper[i], told.ours[i]});
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  f.x_label = "angle of table 2, degrees";
  f.y_label = "angle here (ring fit), degrees";
  f.lines = {marks("combinations of table 2", points, 0),
             dashed("the same angle", {{0, 0}, {56, 56}}, 6)};
}

}  // namespace

std::vector<ReposeRow> repose_combinations() {
  std::set<std::tuple<double, double, double>> seen;
  std::vector<ReposeRow> out;
  for (const ReposeRow& row : paper_repose_table()) {
    if (seen.insert({row.restitution, row.rolling_friction, row.static_friction}).second) {
      out.push_back(
          {row.restitution, row.rolling_friction, row.static_friction, paper_angle_deg(row)});
    }
  }
  return out;
}

std::vector<double> told_angles_deg(const std::vector<HeapResult>& results, std::size_t first,
                                    std::size_t n) {
  std::vector<double> angles;
  for (std::size_t i = first; i < first + n; ++i) {
    if (results[i].tells()) angles.push_back(results[i].angle.ring_deg);
  }
  return angles;
}

std::string untold_text(const std::vector<HeapResult>& results, std::size_t first, std::size_t n) {
  std::map<std::string, int> kinds;
  for (std::size_t i = first; i < first + n; ++i) {
    if (!results[i].tells()) ++kinds[results[i].no_angle];
    if (results[i].is_layer()) ++kinds["layer of 0 degrees"];
  }
  std::string text;
  for (const auto& [kind, count] : kinds) {
    text += (text.empty() ? "" : "; ") + kind + " " + std::to_string(count);
  }
  return text;
}

CorrelationBand correlation_band(const std::vector<double>& paper,
                                 const std::vector<std::vector<double>>& ours, Correlation of) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (paper.size() < kLeastRows) return {kNaN, kNaN};
  sim::Random random(1);
  std::vector<double> values;
  while (values.size() < kDraws) {
    std::vector<double> a, b;
    for (std::size_t i = 0; i < paper.size(); ++i) {
      const auto row = std::size_t(random.next() % paper.size());
      std::vector<double> heaps;
      for (std::size_t k = 0; k < ours[row].size(); ++k) {
        heaps.push_back(ours[row][std::size_t(random.next() % ours[row].size())]);
      }
      a.push_back(paper[row]), b.push_back(mean_of(heaps));
    }
    const double value = of(a, b);
    // All rows the same one: as rare as 13^-12 in a whole table, but not among three.
    values.push_back(std::isnan(value) ? 0 : value);
  }
  std::sort(values.begin(), values.end());
  return {values[kDraws / 40], values[kDraws - 1 - kDraws / 40]};
}

void add_repose_table(Findings& f, const std::vector<HeapResult>& results, std::size_t first,
                      std::size_t seeds, const HeapTest& test) {
  Table table({{"restitution_ratio", 2},
               {"rolling_friction_ratio", 2},
               {"static_friction_ratio", 2},
               {"paper_deg", 2},
               {"ours_deg", 2},
               {"deviation_deg", 2},
               {"half95_deg", 2},
               {"heaps_that_tell_count", 0},
               {"no_angle_name", 0}});
  // Columns as hoof anova takes them; the test is in every row so that a copy still says it.
  Table design({{"e_ratio", 3},
                {"mu_r_ratio", 3},
                {"mu_s_ratio", 3},
                {"seed_count", 0},
                {"repose_deg", 3},
                {"no_angle_name", 0},
                {"grains_count", 0},
                {"outlet_mm", 2},
                {"fall_mm", 2},
                {"step_us", 2}});
  const double fall_m = heap_geometry(test).outlet_z_m;
  Told told;
  const std::vector<ReposeRow> rows = repose_combinations();
  for (const ReposeRow& row : rows) {
    const std::vector<double> angles = told_angles_deg(results, first, seeds);
    const Sample s = sample_of(angles);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    table.row({row.restitution, row.rolling_friction, row.static_friction, row.angle_deg,
               s.n > 0 ? s.mean : nan, s.deviation, s.confidence, static_cast<std::int64_t>(s.n),
               untold_text(results, first, seeds)});
    for (std::size_t i = 0; i < seeds; ++i) {
      const HeapResult& r = results[first + i];
      design.row({row.restitution, row.rolling_friction, row.static_friction,
                  static_cast<std::int64_t>(test.seed + i), r.angle.ring_deg, r.no_angle,
                  static_cast<std::int64_t>(test.grains), rounded(1e3 * test.outlet_m),
                  rounded(1e3 * fall_m), rounded(1e6 * test.step_s)});
    }
    first += seeds;
    if (angles.empty()) continue;
    told.paper.push_back(row.angle_deg), told.ours.push_back(s.mean);
    told.heaps.push_back(angles);
    told.heaps_told += s.n;
  }
  add_targets(f, told, rows.size(), rows.size() * seeds);
  plot(f, told);
  f.rows = table;
  f.rows_name = "table2";
  f.design = design;
}

std::string analyse_repose(const std::filesystem::path& data, const std::filesystem::path& out) {
  AnovaOptions anova;
  anova.data = data;
  anova.factors = {"e_ratio", "mu_r_ratio", "mu_s_ratio"};
  anova.response = "repose_deg";
  anova.has_target = true;
  anova.target = kPaperReposeMeasured_deg;
  anova.tolerance = kPaperReposeError_deg;
  anova.out = out;
  return run_anova(anova);
}

}  // namespace hoof::tools
