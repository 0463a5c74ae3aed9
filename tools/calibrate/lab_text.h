// Small helpers of the laboratories' reports.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tools/calibrate/paper_tables.h"
#include "tools/calibrate/reduction.h"
#include "tools/calibrate/single_grain.h"
#include "tools/study/line_plot.h"
#include "tools/study/statistics.h"

namespace hoof::tools {

/// printf to a string; at most 399 characters.
template <class... Values>
std::string text(const char* format, Values... values) {
  char line[400];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

inline void tell(const LabProgress& progress, double share, const std::string& doing) {
  if (progress && !progress(share, doing)) throw LabStopped();
}

inline std::vector<double> in_mm(std::vector<double> values_m) {
  for (double& v : values_m) v *= 1e3;
  return values_m;
}

/// What bins did to a weighted mean.
inline std::string bins_text(const std::vector<double>& values_mm, double bin_mm) {
  return text(
      "The %d grains of the check scatter by %.2f mm (standard deviation); bins of %.1f mm move "
      "their mean by %+.2f mm. Bins wider than the scatter give the middle of a bin, whatever the "
      "grains do.",
      int(values_mm.size()), values_mm.size() > 1 ? sample_of(values_mm).deviation : 0.0, bin_mm,
      binned_mean(values_mm, bin_mm) - mean_of(values_mm));
}

inline PlotLine line(const std::string& label, const std::vector<PaperRow>& rows, int colour) {
  PlotLine l{label, {}, colour, false, false};
  for (const PaperRow& row : rows) l.points.emplace_back(row.x, row.y);
  return l;
}
inline PlotLine dashed(const std::string& label, const std::vector<PaperRow>& rows, int colour) {
  PlotLine l = line(label, rows, colour);
  l.dashed = true;
  return l;
}
inline PlotLine marks(const std::string& label, const std::vector<PaperRow>& rows, int colour) {
  PlotLine l = line(label, rows, colour);
  l.marks = true;
  return l;
}

}  // namespace hoof::tools
