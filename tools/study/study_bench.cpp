#include "tools/study/study_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

std::vector<std::string> overrides(const StudyOptions& options) {
  std::vector<std::string> all = {"use.bed=bench"};
  if (options.threads) all.push_back("experiment.threads=" + std::to_string(*options.threads));
  all.insert(all.end(), options.settings.begin(), options.settings.end());
  return all;
}

std::filesystem::path out_folder(const std::string& name, const StudyOptions& options) {
  return options.out.empty() ? std::filesystem::path("runs") / ("study-" + name) : options.out;
}

std::filesystem::path bed_folder(const StudyOptions& options) {
  return options.beds.empty() ? std::filesystem::path(HOOF_CACHE_DIR) / "beds" : options.beds;
}

}  // namespace

std::string Box::text() const {
  char text[60];
  std::snprintf(text, sizeof text, "%gx%gx%g", length_m * 1e3, width_m * 1e3, depth_m * 1e3);
  return text;
}

StudyBench::StudyBench(const std::string& name, const StudyOptions& options)
    : name_(name),
      options_(options),
      settings_(read_run_settings("sinkage", overrides(options))),
      folder_(out_folder(name, options)),
      runner_(folder_, bed_folder(options), settings_.materials, settings_.threads,
              choose_progress_style(options.quiet)) {}

sim::BedSettings StudyBench::bed(double scale, const Box& box, bool periodic) const {
  sim::BedSettings bed = settings_.bed;
  bed.name = "study";
  bed.box_length_m = box.length_m;
  bed.box_width_m = box.width_m;
  bed.depth_m = box.depth_m;
  bed.periodic_sides = periodic;
  bed.grain_scale *= scale;
  bed.skin_m *= scale;
  bed.steps_per_ms = int(std::ceil(bed.steps_per_ms / scale));
  bed.settling_steps_per_ms = int(std::ceil(bed.settling_steps_per_ms / scale));
  bed.validate();
  return bed;
}

std::vector<PressCase> StudyBench::over_seeds(const PressCase& c, int bed_count) const {
  std::vector<PressCase> cases(std::size_t(bed_count), c);
  for (int i = 0; i < bed_count; ++i) {
    cases[std::size_t(i)].seed = std::uint64_t(options_.seed + i);
  }
  return cases;
}

double StudyBench::slice_m(double scale) const {
  const double pitch_m = settings_.foot.geometry.spines.middle_pitch_m;
  const double least_m = 6 * scale * settings_.bed.largest_diameter_m();
  // At least two pitches: an image of a spine next to itself would be no row.
  return pitch_m * std::max(2.0, std::ceil(least_m / pitch_m - 1e-9));
}

void StudyBench::finish(const std::string& notes, const Table& table, const std::string& plot_title,
                        const std::string& plot_y, const std::vector<PlotLine>& lines) const {
  table.write_csv(folder_ / (name_ + ".csv"));
  write_file(folder_ / (name_ + ".svg"),
             draw_lines(plot_title, "depth of the sole below the level sand, mm", plot_y, lines));
  std::cout << notes << "\n"
            << table.markdown() << "\n"
            << (folder_ / (name_ + ".csv")).string() << "\n"
            << (folder_ / (name_ + ".svg")).string() << std::endl;
}

PlotLine mean_line(const std::string& label, const std::vector<PressCurve>& curves, double area_m2,
                   int colour, bool dashed) {
  PlotLine line{label, {}, colour, dashed};
  std::size_t n = curves.empty() ? 0 : curves.front().samples.size();
  for (const PressCurve& c : curves) n = std::min(n, c.samples.size());
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (const PressCurve& c : curves) sum += c.samples[i].force_N;
    line.points.emplace_back(curves.front().samples[i].depth_m * 1e3,
                             sum / double(curves.size()) / area_m2 * 1e-3);
  }
  return line;
}

}  // namespace hoof::tools
