#include "tools/experiment/section_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hoof::tools {
namespace {

constexpr double kPixels_m = 1800;  // 530 mm of bed make a drawing 954 pixels wide

/// Appends formatted text; lengths are short, so the buffer is ample.
template <typename... Args>
void append(std::string& text, const char* format, Args... args) {
  char buffer[240];
  const int n = std::snprintf(buffer, sizeof buffer, format, args...);
  text.append(buffer, std::size_t(std::clamp(n, 0, int(sizeof buffer) - 1)));
}

struct Frame {
  double cut_y_m, low_x_m, high_x_m, low_z_m, high_z_m;

  double x(double x_m) const { return (x_m - low_x_m) * kPixels_m; }
  double y(double z_m) const { return (high_z_m - z_m) * kPixels_m; }
};

Frame frame_of(const sim::BedState& bed, const sim::Rig& rig, double cut_y_m) {
  Frame f{cut_y_m, 1e9, -1e9, 1e9, 0.02};
  for (const sim::Grain& g : bed.grains) {
    f.low_x_m = std::min(f.low_x_m, g.p_m.x() - g.radius_m);
    f.high_x_m = std::max(f.high_x_m, g.p_m.x() + g.radius_m);
    f.low_z_m = std::min(f.low_z_m, g.p_m.z() - g.radius_m);
  }
  f.high_z_m = std::max(f.high_z_m, rig.foot_position_m().z() + 0.06);
  return f;
}

/// From the colour of sand to dark red, at one d50 of displacement.
void append_colour(std::string& svg, double moved_over_d50) {
  const double s = std::sqrt(std::clamp(moved_over_d50, 0.0, 1.0));
  const auto mix = [&](int from, int to) { return int(std::lround(from + s * (to - from))); };
  append(svg, "#%02x%02x%02x", mix(0xec, 0x9b), mix(0xdc, 0x1c), mix(0xb4, 0x1c));
}

void draw_grains(std::string& svg, const Frame& f, const sim::BedState& before,
                 const sim::BedState& after, double d50_m) {
  for (std::size_t i = 0; i < after.grains.size(); ++i) {
    const sim::Grain& g = after.grains[i];
    const double off_m = g.p_m.y() - f.cut_y_m;
    if (std::abs(off_m) >= g.radius_m) continue;
    const double cut_m = std::sqrt(g.radius_m * g.radius_m - off_m * off_m);
    append(svg, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"", f.x(g.p_m.x()),
           f.y(g.p_m.z()), cut_m * kPixels_m);
    append_colour(svg, (g.p_m - before.grains[i].p_m).norm() / d50_m);
    svg += "\"/>\n";
  }
}

/// Where the plane cuts the triangles of a body.
void draw_body(std::string& svg, const Frame& f, const sim::Rig& rig, int body) {
  const sim::Pose pose = rig.pose(body);
  const sim::TriangleMesh& mesh = rig.mesh(body);
  for (const auto& t : mesh.triangles) {
    Eigen::Vector3d p[3], cut[2];
    for (int k = 0; k < 3; ++k) {
      p[k] = pose.p_WB_m + pose.q_WB * mesh.vertices_m[std::size_t(t[k])];
      p[k].y() -= f.cut_y_m;
    }
    int cuts = 0;
    for (int k = 0; k < 3 && cuts < 2; ++k) {
      const Eigen::Vector3d &a = p[k], &b = p[(k + 1) % 3];
      if ((a.y() < 0) != (b.y() < 0)) cut[cuts++] = a + a.y() / (a.y() - b.y()) * (b - a);
    }
    if (cuts == 2) {
      append(svg, "<path d=\"M%.1f %.1fL%.1f %.1f\"/>\n", f.x(cut[0].x()), f.y(cut[0].z()),
             f.x(cut[1].x()), f.y(cut[1].z()));
    }
  }
}

}  // namespace

std::string draw_section(const sim::BedState& before, const sim::BedState& after,
                         const sim::Rig& rig, double d50_m, double cut_y_m) {
  const Frame f = frame_of(after, rig, cut_y_m);
  const double width = f.x(f.high_x_m), height = f.y(f.low_z_m);
  std::string svg;
  append(svg,
         "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" role=\"img\" "
         "aria-label=\"Foot in sand, cut lengthwise\">\n",
         width, height + 50);
  append(svg, "<rect width=\"%.0f\" height=\"%.0f\" fill=\"#ffffff\"/>\n", width, height + 50);
  svg += "<g stroke=\"#8a7a55\" stroke-width=\"0.6\">\n";
  draw_grains(svg, f, before, after, d50_m);
  svg += "</g>\n<g stroke=\"#1d3557\" stroke-width=\"3\" stroke-linecap=\"round\" fill=\"none\">\n";
  for (int body = 0; body < rig.body_count(); ++body) draw_body(svg, f, rig, body);
  svg += "</g>\n<g font-family=\"sans-serif\" font-size=\"15\" fill=\"#1d3557\">\n";
  append(svg,
         "<path d=\"M8 %.0fh%.0f\" stroke=\"#1d3557\" stroke-width=\"3\"/>\n"
         "<text x=\"%.0f\" y=\"%.0f\">50 mm; cut at y = %.0f mm</text>\n",
         height + 16, 0.05 * kPixels_m, 16 + 0.05 * kPixels_m, height + 21, cut_y_m * 1e3);
  append(svg,
         "<text x=\"8\" y=\"%.0f\">colour: way of the grains, dark red = d50 (%.1f mm)</text>\n"
         "</g>\n",
         height + 41, d50_m * 1e3);
  svg += "</svg>\n";
  return svg;
}

}  // namespace hoof::tools
