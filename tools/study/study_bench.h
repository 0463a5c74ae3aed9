// What the studies share: settings, beds of any box and grain size, the folder of the results.
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/run_settings.h"
#include "tools/study/case_runner.h"
#include "tools/study/line_plot.h"
#include "tools/study/study.h"
#include "tools/study/table.h"

namespace hoof::tools {

struct Box {
  double length_m = 0;  // x, across a strip
  double width_m = 0;   // y, along a strip
  double depth_m = 0;

  /// "160x60x100", mm
  std::string text() const;
};

class StudyBench {
 public:
  StudyBench(const std::string& name, const StudyOptions& options);

  /// The bed of the settings (preset bench, --set) with other grains and another box. Step and skin
  /// grow with the grains, so that every scale has the same share of its Rayleigh time.
  /// @throws std::invalid_argument where the box is too small for such grains
  sim::BedSettings bed(double scale, const Box& box, bool periodic) const;

  /// One case per seed.
  std::vector<PressCase> over_seeds(const PressCase& c, int bed_count) const;

  const RunSettings& settings() const { return settings_; }
  const StudyOptions& options() const { return options_; }
  CaseRunner& runner() { return runner_; }

  /// Length of a strip's slice: whole spine pitches, and the six largest grains that a bed needs.
  double slice_m(double scale) const;

  /// Writes STUDY.csv and STUDY.svg, prints the table and where everything is.
  void finish(const std::string& notes, const Table& table, const std::string& plot_title,
              const std::string& plot_y, const std::vector<PlotLine>& lines) const;

 private:
  std::string name_;
  StudyOptions options_;
  RunSettings settings_;
  std::filesystem::path folder_;
  CaseRunner runner_;
};

/// Mean curve of several beds: force over area against depth, kPa over mm, from first contact on.
PlotLine mean_line(const std::string& label, const std::vector<PressCurve>& curves, double area_m2,
                   int colour, bool dashed);

}  // namespace hoof::tools
