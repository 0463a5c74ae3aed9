#include "tools/reproduce/target_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/report/html.h"

namespace hoof::tools {
namespace {

constexpr double kWidth = 1010, kLeft = 460, kRight = 20, kTop = 74, kLine = 18, kBottom = 12;
constexpr double kDecades = 1;  // to either side of the paper's number

// Okabe and Ito (2008): told apart by colour-blind readers too.
constexpr const char* kInsideColour = "#009e73";
constexpr const char* kOutsideColour = "#d55e00";
constexpr const char* kNoBandColour = "#7a7a7a";

template <typename... Args>
std::string formed(const char* format, Args... args) {
  char buffer[240];  // numbers and colours; other texts are added whole
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

/// Where a ratio stands, at the edge where it is beyond; nothing and less are at the left one.
double place(double ratio) {
  const double decades = ratio > 0 ? std::clamp(std::log10(ratio), -kDecades, kDecades) : -kDecades;
  return kLeft + (decades + kDecades) / (2 * kDecades) * (kWidth - kLeft - kRight);
}

bool beyond(double ratio) {
  return !(ratio > 0) || std::abs(std::log10(ratio)) > kDecades;
}

const char* colour_of(Judgement judgement) {
  if (judgement == Judgement::kInside) return kInsideColour;
  return judgement == Judgement::kOutside ? kOutsideColour : kNoBandColour;
}

std::string mark(double ratio, double y, const char* colour, bool hollow) {
  const std::string paint =
      formed("fill=\"%s\" stroke=\"%s\"", hollow ? "#ffffff" : colour, colour);
  const double x = place(ratio);
  if (!beyond(ratio)) {
    return formed("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" %s/>", x, y, paint.c_str());
  }
  const double tip = ratio > 1 ? 8 : -8;
  return formed("<path class=\"beyond\" d=\"M%.1f %.1fl%.0f 5l%.0f 5z\" %s/>", x - tip, y - 5, tip,
                -tip, paint.c_str());
}

std::string line_of(const Comparison& row, double y) {
  std::string svg = formed("<text x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">", kLeft - 12, y + 4) +
                    html_escape(row.name) + "</text>";
  if (row.low != 0 || row.high != 0) {
    const double from = place(row.low / row.paper), to = place(row.high / row.paper);
    svg += formed(
        "<rect class=\"band\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"12\" "
        "fill=\"#d3d9df\"/>",
        from, y - 6, to - from);
  }
  const char* colour = colour_of(row.judgement());
  const double ours = row.ours->mean / row.paper;
  if (std::isfinite(row.ours->deviation) && row.ours->deviation > 0) {
    const double half = row.ours->deviation / row.paper;
    svg += formed("<path d=\"M%.1f %.1fH%.1f\" stroke=\"%s\" stroke-width=\"1.5\"/>",
                  place(ours - half), y, place(ours + half), colour);
  }
  return svg + mark(ours, y, colour, row.standing == Standing::kInput) + "\n";
}

std::string legend() {
  const double y = 34;
  double x = kLeft;
  std::string svg;
  const auto say = [&](const std::string& sign, const std::string& text) {
    svg += sign + formed("<text x=\"%.1f\" y=\"%.1f\">", x + 12, y + 4) + text + "</text>";
    x += 30 + 6.2 * double(text.size());
  };
  const auto dot = [&](const char* colour, bool hollow) {
    return formed("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\" stroke=\"%s\"/>", x, y,
                  hollow ? "#ffffff" : colour, colour);
  };
  say(dot(kInsideColour, false), "inside");
  say(dot(kOutsideColour, false), "outside");
  say(dot(kNoBandColour, false), "no band");
  say(dot(kOutsideColour, true), "hollow: an input");
  say(formed("<rect x=\"%.1f\" y=\"%.1f\" width=\"16\" height=\"12\" fill=\"#d3d9df\"/>", x - 8,
             y - 6),
      "accepted");
  return svg + "\n";
}

}  // namespace

std::string draw_targets(const std::vector<Comparison>& rows) {
  std::vector<const Comparison*> drawn;
  for (const Comparison& row : rows) {
    if (row.ours && std::isfinite(row.ours->mean) && row.paper > 0) drawn.push_back(&row);
  }
  if (drawn.empty()) return "";
  const double height = kTop + kLine * double(drawn.size()) + kBottom;
  std::string svg = formed(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n"
      "<text x=\"%.0f\" y=\"18\" font-size=\"15\">Ours over the paper's number</text>\n",
      kWidth, height, kLeft);
  svg += legend();
  for (const double ratio : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0}) {
    svg += formed("<path d=\"M%.1f %.1fV%.1f\" stroke=\"%s\"/>", place(ratio), kTop - 8,
                  height - kBottom, ratio == 1 ? "#444444" : "#dddddd");
    svg += formed("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%g</text>\n", place(ratio),
                  kTop - 12, ratio);
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    svg += line_of(*drawn[i], kTop + kLine * (double(i) + 0.5));
  }
  return svg + "</svg>\n";
}

}  // namespace hoof::tools
