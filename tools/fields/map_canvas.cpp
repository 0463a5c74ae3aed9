#include "tools/fields/map_canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/fields/field_map.h"

namespace hoof::tools {
namespace {

/// Appends formatted text; pieces are short, so the buffer is ample.
template <typename... Args>
void append(std::string& text, const char* format, Args... args) {
  char buffer[400];
  const int n = std::snprintf(buffer, sizeof buffer, format, args...);
  text.append(buffer, std::size_t(std::clamp(n, 0, int(sizeof buffer) - 1)));
}

}  // namespace

ColourBar ColourBar::of(std::vector<double> values, double factor, std::string unit) {
  ColourBar bar{1, factor, std::move(unit)};
  std::sort(values.begin(), values.end());
  if (!values.empty()) bar.most = values[std::size_t(0.99 * double(values.size() - 1))];
  if (!(bar.most > 0)) bar.most = values.empty() || !(values.back() > 0) ? 1 : values.back();
  return bar;
}

std::string ColourBar::colour(double value) const {
  return viridis(value / most);
}

MapCanvas::MapCanvas(const Eigen::AlignedBox2d& window_m, std::string label)
    : window_m_(window_m), label_(std::move(label)) {}

void MapCanvas::circle(const Eigen::Vector2d& at_m, double radius_m, const std::string& fill) {
  if (window_m_.exteriorDistance(at_m) > radius_m) return;
  append(body_, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>\n", x_px(at_m.x()),
         y_px(at_m.y()), radius_m * kPixels_m, fill.c_str());
}

void MapCanvas::line(const Eigen::Vector2d& a_m, const Eigen::Vector2d& b_m, double width_px,
                     const std::string& colour) {
  if (!window_m_.contains(a_m) && !window_m_.contains(b_m)) return;
  append(body_, "<path d=\"M%.1f %.1fL%.1f %.1f\" stroke=\"%s\" stroke-width=\"%.1f\"/>\n",
         x_px(a_m.x()), y_px(a_m.y()), x_px(b_m.x()), y_px(b_m.y()), colour.c_str(), width_px);
}

void MapCanvas::rectangle(const Eigen::AlignedBox2d& box_m, const std::string& fill) {
  append(body_,
         "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" "
         "fill=\"%s\" shape-rendering=\"crispEdges\"/>\n",
         x_px(box_m.min().x()), y_px(box_m.max().y()), box_m.sizes().x() * kPixels_m,
         box_m.sizes().y() * kPixels_m, fill.c_str());
}

void MapCanvas::triangle(const Eigen::Vector2d corners_m[3], const std::string& fill) {
  append(body_,
         "<path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fz\" fill=\"%s\" "
         "shape-rendering=\"crispEdges\"/>\n",
         x_px(corners_m[0].x()), y_px(corners_m[0].y()), x_px(corners_m[1].x()),
         y_px(corners_m[1].y()), x_px(corners_m[2].x()), y_px(corners_m[2].y()), fill.c_str());
}

std::string MapCanvas::finish(const ColourBar& bar) const {
  constexpr double kBelow_px = 46, kBar_px = 200, kTextInk_px = 13;
  const double width = window_m_.sizes().x() * kPixels_m,
               height = window_m_.sizes().y() * kPixels_m;
  std::string svg;
  append(svg, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" role=\"img\" ",
         width, height + kBelow_px);
  svg += "aria-label=\"" + label_ + "\">\n";
  append(svg, "<rect width=\"%.0f\" height=\"%.0f\" fill=\"#ffffff\"/>\n", width,
         height + kBelow_px);
  append(svg, "<svg width=\"%.0f\" height=\"%.0f\"><g stroke-linecap=\"round\">\n", width, height);
  svg += body_ + "</g></svg>\n";
  const double top = height + 8;
  constexpr int kSteps = 50;
  for (int k = 0; k < kSteps; ++k) {
    append(svg, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"12\" fill=\"%s\"/>\n",
           8 + k * kBar_px / kSteps, top, kBar_px / kSteps + 0.5,
           viridis((k + 0.5) / kSteps).c_str());
  }
  append(svg, "<g font-family=\"sans-serif\" font-size=\"%.0f\" fill=\"#1b1f24\">", kTextInk_px);
  append(svg, "<text x=\"8\" y=\"%.1f\">0</text>", top + 28);
  append(svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.3g</text>", 8 + kBar_px, top + 28,
         bar.factor * bar.most);
  append(svg, "<text x=\"%.1f\" y=\"%.1f\">%s</text>", 16 + kBar_px, top + 11, bar.unit.c_str());
  const double scale = 0.05 * kPixels_m;
  append(svg, "<path d=\"M%.1f %.1fh%.1f\" stroke=\"#1b1f24\" stroke-width=\"3\"/>",
         width - 12 - scale, top + 6, scale);
  append(svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">50 mm</text></g>\n", width - 12,
         top + 28);
  return svg + "</svg>\n";
}

}  // namespace hoof::tools
