#include "tools/reproduce/target_chart.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>

#include "tests/tools/reproduce/occurrences.h"

using namespace hoof::tools;
using hoof::tests::occurrences;

namespace {

Comparison target(const char* name, double paper, double low, double high, double ours) {
  Comparison row;
  row.name = name, row.unit = "mm", row.paper = paper, row.low = low, row.high = high;
  row.ours = Sample{.n = 5, .mean = ours, .deviation = 0.1 * std::abs(ours)};
  return row;
}

/// Of the line with that name: its text, band and mark.
std::string line_of(const std::string& svg, const std::string& name) {
  const auto at = svg.find(">" + name + "</text>");
  REQUIRE(at != std::string::npos);
  return svg.substr(at, svg.find('\n', at) - at);
}

double number(const std::string& text, const std::string& before) {
  std::smatch found;
  REQUIRE(std::regex_search(text, found, std::regex(before + "=\"([0-9.]+)\"")));
  return std::stod(found[1]);
}

}  // namespace

TEST_CASE("targets at a glance: a mark where ours over the paper's is, the band around it") {
  const auto equal = target("equal", 8, 4, 16, 8), twice = target("twice", 3, 1.5, 6, 6);
  const auto half = target("half & less", 10, 9, 11, 5);
  const std::string svg = draw_targets({equal, twice, half});
  const double one = number(line_of(svg, "equal"), "cx");
  const double two = number(line_of(svg, "twice"), "cx");
  // Logarithmic: as far to one side as to the other, and no matter what the paper's number is.
  CHECK(number(line_of(svg, "half &amp; less"), "cx") == Approx(2 * one - two).margin(0.11));
  const std::string line = line_of(svg, "equal");
  CHECK(number(line, "rect class=\"band\" x") == Approx(2 * one - two).margin(0.11));
  CHECK(number(line, "width") == Approx(2 * (two - one)).margin(0.11));
  // A decade either way is the width of the chart: log 2 of it from the middle.
  CHECK((two - one) / std::log10(2.0) == Approx((1010 - 460 - 20) / 2.0).margin(0.4));
  CHECK(occurrences(line_of(svg, "twice"), "#009e73") > 0);
  CHECK(occurrences(line_of(svg, "half &amp; less"), "#d55e00") > 0);
}

TEST_CASE("targets at a glance: inputs are hollow, what is far off or nothing stands at its edge") {
  auto input = target("input", 8, 4, 16, 8);
  input.standing = Standing::kInput;
  const std::string svg =
      draw_targets({input, target("far", 1, 0.5, 2, 30), target("none", 1, 0.5, 2, 0),
                    target("bandless", 2, 0, 0, 3)});
  CHECK(occurrences(line_of(svg, "input"), "fill=\"#ffffff\"") == 1);
  CHECK(occurrences(line_of(svg, "bandless"), "class=\"band\"") == 0);
  CHECK(occurrences(line_of(svg, "bandless"), "#7a7a7a") > 0);
  CHECK(occurrences(svg, "class=\"beyond\"") == 2);
  // Triangles that begin eight from their tips, which are at the right and the left edge.
  CHECK(occurrences(line_of(svg, "far"), "d=\"M982.0") == 1);
  CHECK(occurrences(line_of(svg, "none"), "d=\"M468.0") == 1);
}

TEST_CASE("targets at a glance: only what was run and what the paper has a number of") {
  auto not_run = target("not run", 1, 0.5, 2, 1);
  not_run.ours.reset();
  const auto none = target("no number", 0, 0, 1, 0.5), unknown = target("unknown", NAN, 0, 1, 0.5);
  CHECK(draw_targets({not_run, none, unknown}).empty());
  CHECK(draw_targets({}).empty());
  const std::string svg = draw_targets({not_run, none, target("run", 1, 0.5, 2, 1), unknown});
  CHECK(occurrences(svg, ">run<") == 1);
  for (const char* name : {"not run", "no number", "unknown"}) CHECK(occurrences(svg, name) == 0);
}
