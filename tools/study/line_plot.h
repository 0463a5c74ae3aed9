// Curves over one axis as an SVG file that any browser opens.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hoof::tools {

struct PlotLine {
  std::string label;
  std::vector<std::pair<double, double>> points;
  int colour = 0;  // lines of one group share it
  bool dashed = false;
  bool marks = false;  // a circle at each point in place of the line: what was measured or printed
  std::vector<double> half_range = {};  // of a bar at each point, in y; empty, NaN: none
};

/// kFromZero: both axes begin at zero. kTight: they cover the points.
enum class PlotAxes { kFromZero, kTight };

/// @param x_label, y_label with their units
std::string draw_lines(const std::string& title, const std::string& x_label,
                       const std::string& y_label, const std::vector<PlotLine>& lines,
                       PlotAxes axes = PlotAxes::kFromZero);

}  // namespace hoof::tools
