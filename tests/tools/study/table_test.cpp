#include "tools/study/table.h"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/study/line_plot.h"

using namespace hoof::tools;
using hoof::tests::ScratchFolder;

namespace {

Table example() {
  Table table({{"body_name"}, {"depth_mm", 1}, {"bed_count"}, {"effect_ratio", 3}});
  table.row({std::string("strip"), 5.0, std::int64_t(12), 1.0625});
  table.row({std::string("half strip"), -13.25, std::int64_t(5),
             std::numeric_limits<double>::quiet_NaN()});
  return table;
}

}  // namespace

TEST_CASE("a table prints as Markdown, with units and without numbers that are none") {
  CHECK(example().markdown() ==
        "| body       | depth, mm | bed | effect |\n"
        "| ---------- | --------- | --- | ------ |\n"
        "| strip      | 5.0       | 12  | 1.062  |\n"
        "| half strip | -13.2     | 5   | -      |\n");
}

TEST_CASE("a unit of two bytes and one column stands as wide as it looks") {
  Table angles({{"repose_deg", 1}});
  angles.row({32.25});
  CHECK(angles.markdown() ==
        "| repose, ° |\n"
        "| --------- |\n"
        "| 32.2      |\n");
}

TEST_CASE("the same table as CSV keeps every digit") {
  const ScratchFolder scratch;
  example().write_csv(scratch.path() / "t.csv");
  CHECK(read_file(scratch.path() / "t.csv") ==
        "body_name,depth_mm,bed_count,effect_ratio\n"
        "strip,5,12,1.0625\n"
        "half strip,-13.25,5,nan\n");
  CHECK_FALSE(std::filesystem::exists(scratch.path() / "t.csv.partial"));
  CHECK_THROWS_AS(example().write_csv(scratch.path() / "no" / "t.csv"), UserError);
}

TEST_CASE("a row of the wrong width is refused") {
  Table table = example();
  CHECK_THROWS_WITH(table.row({1.0}), "table: 1 cells for 4 columns");
  CHECK(table.rows() == 2);
}

TEST_CASE("a plot spans its points, leaves out what is no number, and escapes its labels") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg =
      draw_lines("a < b", "depth, mm", "kPa",
                 {{"plain & spined", {{-5, 0}, {0, 10}, {5, nan}, {10, 40}}, 0, true}});
  CHECK_THAT(svg, Catch::StartsWith("<svg ") && Catch::EndsWith("</svg>\n"));
  CHECK_THAT(svg, Catch::Contains("a &lt; b") && Catch::Contains("plain &amp; spined"));
  // -5 to 10 over 70 to 640 and 0 to 40 over 470 to 40: three points.
  CHECK_THAT(svg, Catch::Contains("points=\"70.0,470.0 260.0,362.5 640.0,40.0 \""));
  CHECK_THAT(svg, Catch::Contains("stroke-dasharray"));
  CHECK_THAT(draw_lines("", "", "", {}), Catch::EndsWith("</svg>\n"));
}
