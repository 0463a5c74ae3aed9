#include "tools/study/line_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "tools/report/html.h"

namespace hoof::tools {
namespace {

constexpr double kWidth = 900, kHeight = 520, kLeft = 70, kRight = 260, kTop = 40, kBottom = 50;
// Okabe and Ito (2008): told apart by colour-blind readers too.
constexpr std::array kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                 "#e69f00", "#56b4e9", "#000000"};

template <typename... Args>
void append(std::string& text, const char* format, Args... args) {
  char buffer[200];  // numbers only; texts are added whole
  std::snprintf(buffer, sizeof buffer, format, args...);
  text += buffer;
}

struct Axis {
  double low = 0, high = 0;

  /// Covers no value yet, not even zero.
  static Axis empty() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {kFar, -kFar};
  }
  void cover(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// 1, 2 or 5 times a power of ten: four to ten marks over the range.
  double mark() const {
    const double range = high > low ? high - low : 1;
    const double power = std::pow(10, std::floor(std::log10(range / 4)));
    for (const double step : {5.0, 2.0}) {
      if (range / (step * power) >= 4) return step * power;
    }
    return power;
  }
};

class Plot {
 public:
  Plot(const std::vector<PlotLine>& lines, PlotAxes axes) {
    if (axes == PlotAxes::kTight) x_ = y_ = Axis::empty();
    for (const PlotLine& line : lines) {
      for (std::size_t i = 0; i < line.points.size(); ++i) {
        const auto& [x, y] = line.points[i];
        const bool has_bar = i < line.half_range.size() && std::isfinite(line.half_range[i]);
        const double bar = has_bar ? line.half_range[i] : 0;
        x_.cover(x), y_.cover(y - bar), y_.cover(y + bar);
      }
    }
    for (Axis* axis : {&x_, &y_}) {
      if (axis->low > axis->high) *axis = {};
      if (axes == PlotAxes::kTight) {
        const double room = 0.04 * (axis->high - axis->low);
        axis->low -= room, axis->high += room;
      }
    }
    if (x_.high == x_.low) x_.high = x_.low + 1;
    if (y_.high == y_.low) y_.high = y_.low + 1;
  }

  void grid(std::string& svg) const {
    for (double v = std::ceil(x_.low / x_.mark()) * x_.mark(); v <= x_.high; v += x_.mark()) {
      append(svg, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#ddd\"/>", x(v), kTop, kHeight - kBottom);
      append(svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%g</text>\n", x(v),
             kHeight - kBottom + 16, std::abs(v) < 1e-9 * x_.mark() ? 0.0 : v);
    }
    for (double v = std::ceil(y_.low / y_.mark()) * y_.mark(); v <= y_.high; v += y_.mark()) {
      append(svg, "<path d=\"M%.1f %.1fH%.1f\" stroke=\"#ddd\"/>", kLeft, y(v), kWidth - kRight);
      append(svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", kLeft - 6,
             y(v) + 4, std::abs(v) < 1e-9 * y_.mark() ? 0.0 : v);
    }
  }

  void line(std::string& svg, const PlotLine& line, std::size_t index) const {
    const char* colour = kColours[std::size_t(line.colour) % kColours.size()];
    const char* dash = line.dashed ? " stroke-dasharray=\"5 4\"" : "";
    const double at_y = kTop + 8 + 16 * double(index);
    if (line.marks) {
      for (const auto& [px, py] : line.points) {
        if (std::isfinite(px) && std::isfinite(py)) circle(svg, x(px), y(py), colour);
      }
      circle(svg, kWidth - kRight + 24, at_y, colour);
      label(svg, line, at_y);
      return;
    }
    append(svg, "<polyline fill=\"none\" stroke=\"%s\"%s stroke-width=\"1.6\" points=\"", colour,
           dash);
    for (const auto& [px, py] : line.points) {
      if (std::isfinite(px) && std::isfinite(py)) append(svg, "%.1f,%.1f ", x(px), y(py));
    }
    svg += "\"/>\n";
    for (std::size_t i = 0; i < std::min(line.half_range.size(), line.points.size()); ++i) {
      const auto& [px, py] = line.points[i];
      const double half = line.half_range[i];
      if (!std::isfinite(px) || !std::isfinite(py) || !std::isfinite(half)) continue;
      append(svg, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"%s\"/>", x(px), y(py - half), y(py + half),
             colour);
      append(svg, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x(px), y(py), colour);
    }
    append(svg, "<path d=\"M%.1f %.1fh24\" stroke=\"%s\"%s stroke-width=\"2\"/>",
           kWidth - kRight + 12, at_y, colour, dash);
    label(svg, line, at_y);
  }

 private:
  static void circle(std::string& svg, double cx, double cy, const char* colour) {
    append(svg, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"none\" stroke=\"%s\"/>\n", cx, cy,
           colour);
  }
  static void label(std::string& svg, const PlotLine& line, double at_y) {
    append(svg, "<text x=\"%.1f\" y=\"%.1f\">", kWidth - kRight + 42, at_y + 4);
    svg += html_escape(line.label) + "</text>\n";
  }
  double x(double v) const {
    return kLeft + (v - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight);
  }
  double y(double v) const {
    return kHeight - kBottom - (v - y_.low) / (y_.high - y_.low) * (kHeight - kTop - kBottom);
  }

  Axis x_, y_;
};

}  // namespace

std::string draw_lines(const std::string& title, const std::string& x_label,
                       const std::string& y_label, const std::vector<PlotLine>& lines,
                       PlotAxes axes) {
  std::string svg;
  append(svg,
         "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
         "font-family=\"sans-serif\" font-size=\"12\">\n"
         "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n",
         kWidth, kHeight);
  append(svg, "<text x=\"%.0f\" y=\"20\" font-size=\"15\">", kLeft);
  svg += html_escape(title) + "</text>\n";
  append(svg, "<text x=\"%.0f\" y=\"%.0f\" text-anchor=\"middle\">", (kLeft + kWidth - kRight) / 2,
         kHeight - 12);
  svg += html_escape(x_label) + "</text>\n";
  append(svg, "<text x=\"%.0f\" y=\"34\">", kLeft - 60);
  svg += html_escape(y_label) + "</text>\n";
  const Plot plot(lines, axes);
  plot.grid(svg);
  for (std::size_t i = 0; i < lines.size(); ++i) plot.line(svg, lines[i], i);
  return svg + "</svg>\n";
}

}  // namespace hoof::tools
