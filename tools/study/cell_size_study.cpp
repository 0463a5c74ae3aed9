// The same press with cells of the neighbour search from 2 to 6 of the smallest radii: how fast,
// and whether anything but the order of sums changes.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tools/study/study_bench.h"

namespace hoof::tools {
namespace {

constexpr double kCells_radii[] = {0, 2, 3, 4, 5, 6};  // 0: the engine's own choice
constexpr double kDepth_m = 5.5e-3;
constexpr double kBoxLength_m = 0.24, kBoxDepth_m = 0.1;
constexpr double kFrom_m = 0.5e-3, kTo_m = 5e-3, kWindow_m = 0.25e-3;

/// Largest difference of the force at any depth over the reference's largest force.
double largest_difference(const PressCurve& curve, const PressCurve& reference) {
  double largest = 0, force_N = 0;
  for (double d = kFrom_m; d <= kTo_m + 1e-9; d += kWindow_m) {
    const double a = curve.force_at_N(d, kWindow_m), b = reference.force_at_N(d, kWindow_m);
    largest = std::max(largest, std::abs(a - b));
    force_N = std::max(force_N, std::abs(b));
  }
  return largest / force_N;
}

}  // namespace

void run_cell_size_study(const StudyOptions& options) {
  StudyBench bench("cell-size", options);
  const double scale = options.scales.empty() ? (options.full ? 1 : 2.1) : options.scales.front();
  const Box box{options.lengths_mm.empty() ? kBoxLength_m : options.lengths_mm.front() * 1e-3,
                bench.slice_m(scale), kBoxDepth_m};
  PressCase base;
  base.bed = bench.bed(scale, box, true);
  base.indenter = make_strip(bench.settings().foot.geometry, box.width_m, false);
  base.speed_m_s = bench.settings().sinkage.speed_m_s;
  base.depth_m = kDepth_m;
  std::vector<PressCase> cases;
  for (const double radii : kCells_radii) {
    base.cell_m = radii * base.bed.smallest_diameter_m() / 2;
    const auto beds = bench.over_seeds(base, options.bed_count.value_or(1));
    cases.insert(cases.end(), beds.begin(), beds.end());
  }
  const std::vector<PressCurve> curves = bench.runner().run("cell-size", cases);

  const std::size_t beds = cases.size() / std::size(kCells_radii);
  Table table({{"cell_mm", 2},
               {"over_smallest_radius_ratio", 1},
               {"seed_count"},
               {"time_s", 2},
               {"particle_step_count"},
               {"particle_step_rate_Hz", 0},
               {"rebuild_count"},
               {"force_N", 2},
               {"largest_difference_ratio", 5}});
  std::vector<PlotLine> lines;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const PressCase& c = cases[i];
    const double wall_s = curves[i].samples.back().wall_s;
    const double particle_steps = curves[i].grain_count * c.steps();
    table.row({c.cell_m * 1e3, c.cell_m / (0.5 * c.bed.smallest_diameter_m()), std::int64_t(c.seed),
               wall_s, std::int64_t(particle_steps), particle_steps / wall_s,
               std::int64_t(curves[i].samples.back().rebuild_count), curves[i].force_at_N(kTo_m),
               largest_difference(curves[i], curves[i % beds])});
    if (i % beds == 0) {
      char label[60];
      std::snprintf(label, sizeof label, "cell %.2f mm", c.cell_m * 1e3);
      lines.push_back(mean_line(label, {curves[i]},
                                box.width_m * bench.settings().foot.geometry.middle.width_m,
                                int(lines.size()), false));
    }
  }
  char notes[600];
  std::snprintf(
      notes, sizeof notes,
      "A plain strip in a bed of %s mm, %.0f grains of d50 %.2f mm; cell 0 is the engine's\n"
      "own choice, which the others are compared with. Times are of this machine, now, and\n"
      "of %d threads; a finished case keeps the time it once took.\n",
      box.text().c_str(), curves.front().grain_count, base.bed.d50_m() * 1e3,
      bench.settings().threads);
  bench.finish(notes, table, "Force by cell size", "kPa", lines);
}

}  // namespace hoof::tools
