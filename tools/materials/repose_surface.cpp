#include "tools/materials/repose_surface.h"

#include <algorithm>

#include "tools/calibrate/lab_text.h"
#include "tools/calibrate/paper_tables.h"
#include "tools/design_of_experiments/anova_report.h"
#include "tools/diagnose/csv_table.h"

namespace hoof::tools {
namespace {

// The box of table 2.
const std::vector<Factor> kBox = {{"e", 0.1, 0.8}, {"mu_r", 0.1, 0.4}, {"mu_s", 0.2, 0.9}};

ReposeSurface fitted(const std::string& name, const std::string& made_of, const Runs& runs) {
  const auto [low, high] = std::minmax_element(runs.response.begin(), runs.response.end());
  return {name, made_of, ResponseSurface(kBox, runs, SurfaceModel::kQuadratic), *low, *high};
}

/// What made the heaps, of the first row: all have the same.
std::string test_text(const std::filesystem::path& file, std::size_t heaps) {
  const std::vector<std::string> names = {"grains_count", "outlet_mm", "fall_mm", "step_us"};
  const CsvTable table = read_csv(file, {names.begin(), names.end()});
  std::vector<double> of;
  for (const std::string& name : names) {
    const int at = table.find(name);
    of.push_back(at < 0 || table.columns[std::size_t(at)].empty()
                     ? 0.0
                     : table.columns[std::size_t(at)].front());
  }
  return text(
      "%d heaps of %.0f grains of 2 to 6.4 mm through an outlet of %.0f mm, %.0f mm above a "
      "plate (hoof calibrate repose --full)",
      int(heaps), of[0], of[1], of[2]);
}

}  // namespace

ReposeSurface surface_of_heaps(const std::filesystem::path& design_csv) {
  const Runs runs = read_runs(design_csv, {"e_ratio", "mu_r_ratio", "mu_s_ratio"}, "repose_deg");
  return fitted("heaps of this engine", test_text(design_csv, runs.response.size()), runs);
}

ReposeSurface surface_of_paper() {
  Runs runs;
  runs.source = "table 2";
  for (const ReposeRow& row : paper_repose_table()) {
    runs.factors.push_back({row.restitution, row.rolling_friction, row.static_friction});
    runs.response.push_back(row.angle_deg);
  }
  return fitted("table 2 of the source paper", "17 simulated heaps of Ji et al. 2026", runs);
}

}  // namespace hoof::tools
