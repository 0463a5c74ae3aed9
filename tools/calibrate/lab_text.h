// Small helpers of the laboratories' reports.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tools/calibrate/paper_tables.h"
#include "tools/calibrate/single_grain.h"
#include "tools/study/line_plot.h"

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
