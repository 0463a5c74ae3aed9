// The same press on the same bed with longer and longer steps.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/dem/contact_material.h"
#include "tools/study/study_bench.h"

namespace hoof::tools {
namespace {

/// At the paper's grain size (smallest radius 1 mm); others in proportion to their grains. The
/// first is what the others are compared with.
constexpr double kSteps_s[] = {2e-6, 2.8e-6, 4e-6, 5.6e-6, 8e-6, 12e-6};
/// The paper's two.
constexpr double kSpeeds_m_s[] = {0.1, 0.4};
constexpr double kDepth_m = 5.5e-3;
/// Between depths as far apart as their windows are wide.
constexpr double kFrom_m = 1e-3, kTo_m = 5e-3, kWindow_m = 0.25e-3;
constexpr double kBoxLength_m = 0.16, kBoxDepth_m = 0.1;

struct Difference {
  double mean = 0, rms = 0;  // over the mean force of the reference
};

Difference difference(const PressCurve& curve, const PressCurve& reference) {
  double sum = 0, squares = 0, force_N = 0;
  int n = 0;
  for (double d = kFrom_m; d <= kTo_m + 1e-9; d += 2 * kWindow_m, ++n) {
    const double a = curve.force_at_N(d, kWindow_m), b = reference.force_at_N(d, kWindow_m);
    sum += a - b;
    squares += (a - b) * (a - b);
    force_N += b;
  }
  return {sum / force_N, std::sqrt(squares / n) / (force_N / n)};
}

std::string microseconds(double dt_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g us", dt_s * 1e6);
  return text;
}

}  // namespace

void run_time_step_study(const StudyOptions& options) {
  StudyBench bench("time-step", options);
  const double scale = options.scales.empty() ? (options.full ? 1 : 2.1) : options.scales.front();
  const Box box{options.lengths_mm.empty() ? kBoxLength_m : options.lengths_mm.front() * 1e-3,
                bench.slice_m(scale), kBoxDepth_m};
  PressCase base;
  base.bed = bench.bed(scale, box, true);
  base.indenter = make_strip(bench.settings().foot.geometry, box.width_m, true);
  base.depth_m = kDepth_m;
  std::vector<PressCase> cases;
  for (const double speed_m_s : kSpeeds_m_s) {
    for (const double dt_s : kSteps_s) {
      base.speed_m_s = speed_m_s;
      base.dt_s = dt_s * scale;
      const auto beds = bench.over_seeds(base, options.bed_count.value_or(1));
      cases.insert(cases.end(), beds.begin(), beds.end());
    }
  }
  const std::vector<PressCurve> curves = bench.runner().run("time-step", cases);

  const double rayleigh_s = sim::rayleigh_time_s(
      sim::dem_settings(base.bed, bench.settings().materials, 1).grain_material,
      base.bed.smallest_diameter_m() / 2);
  Table table({{"speed_m_s", 1},
               {"step_us", 2},
               {"over_rayleigh_ratio", 3},
               {"seed_count"},
               {"force_Pa", 0},
               {"mean_difference_ratio", 4},
               {"rms_difference_ratio", 4},
               {"fastest_m_s", 2},
               {"overlap_ratio", 4},
               {"outcome_name"}});
  std::vector<PlotLine> lines;
  const double area_m2 = box.width_m * bench.settings().foot.geometry.middle.width_m;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto same = [&](const PressCase& c) {
      return c.seed == cases[i].seed && c.speed_m_s == cases[i].speed_m_s;
    };
    const std::size_t reference =
        std::size_t(std::find_if(cases.begin(), cases.end(), same) - cases.begin());
    const Difference d = difference(curves[i], curves[reference]);
    double fastest_m_s = 0;
    for (const PressSample& s : curves[i].samples) {
      fastest_m_s = std::max(fastest_m_s, s.fastest_m_s);
    }
    table.row({cases[i].speed_m_s, cases[i].step_s() * 1e6, cases[i].step_s() / rayleigh_s,
               std::int64_t(cases[i].seed), curves[i].force_at_N(kTo_m) / area_m2, d.mean, d.rms,
               fastest_m_s, curves[i].samples.back().overlap_ratio,
               std::string(curves[i].blow_up.empty() ? "done" : "blew up")});
    if (cases[i].speed_m_s == kSpeeds_m_s[0] && cases[i].seed == cases.front().seed) {
      lines.push_back(mean_line(microseconds(cases[i].step_s()), {curves[i]}, area_m2,
                                int(lines.size()), false));
    }
  }
  char notes[700];
  std::snprintf(
      notes, sizeof notes,
      "A spined strip in a bed of %s mm, %.0f grains of d50 %.2f mm, seeds from %lld. The\n"
      "force is that at %g mm over the sole; differences are from the shortest step, over\n"
      "depths of %g to %g mm, over the mean force there. Each run starts from the same\n"
      "settled bed, made with %.2f us.\n",
      box.text().c_str(), curves.front().grain_count, base.bed.d50_m() * 1e3,
      static_cast<long long>(options.seed), kTo_m * 1e3, kFrom_m * 1e3, kTo_m * 1e3,
      base.bed.step_s() * 1e6);
  bench.finish(notes, table, "Force by time step, 0.1 m/s", "kPa", lines);
}

}  // namespace hoof::tools
