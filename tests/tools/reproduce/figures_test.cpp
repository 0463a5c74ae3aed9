#include "tools/reproduce/figures.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/tools/reproduce/occurrences.h"
#include "tools/reproduce/paper.h"
#include "tools/reproduce/paper_numbers.h"

using namespace hoof::tools;
using hoof::tests::occurrences;

TEST_CASE("figures: only of what was run, the paper's numbers dashed beside ours with bars") {
  CHECK(draw_figures({}).empty());
  Outcomes outcomes;
  for (int bed = 1; bed <= 5; ++bed) {
    for (const PaperSinkage& row : paper_sinkages()) {
      outcomes[row.condition][bed].sinkage_mm = row.sinkage_mm * (0.9 + 0.04 * bed);
    }
    for (const PaperTraction& row : paper_tractions()) {
      Outcome& o = outcomes[row.condition][bed];
      o.fx_peak_N = 100, o.fz_at_fx_peak_N = 200, o.coefficient = 0.5 + 0.01 * bed;
      // The mean over a stance has its bar where the beds differ.
      o.trace.fx_N = {0, 50, 100, 50, 40, 30.0 + bed, 20}, o.trace.fz_N = {10, 100, 200, 100};
    }
  }
  const auto figures = draw_figures(outcomes);
  std::vector<std::string> names;
  for (const Figure& figure : figures) {
    INFO(figure.name);
    names.push_back(figure.name);
    CHECK(figure.svg.starts_with("<svg"));
    CHECK(occurrences(figure.svg, "stroke-dasharray") > 0);
    CHECK(occurrences(figure.svg, ", paper<") > 0);
    CHECK(occurrences(figure.svg, ", ours<") == occurrences(figure.svg, ", paper<"));
  }
  CHECK(names == std::vector<std::string>{"sinkage-load-0.1m_s", "sinkage-load-0.4m_s",
                                          "sinkage-opening", "traction-coefficient", "traction-fx",
                                          "traction-fz", "traction-fx-time-0.45Hz",
                                          "traction-fz-time-0.45Hz", "traction-fx-time-1.12Hz",
                                          "traction-fz-time-1.12Hz", "traction-opening"});
  // In the middle of ten points: the sixth, a bar for each of the three feet, and none of Fz.
  CHECK(occurrences(figures[6].svg, "<circle") == 3);
  CHECK(occurrences(figures[7].svg, "<circle") == 0);
  // Three feet, two loads each (the spined one has a third from the openings), a bar and mark each.
  CHECK(occurrences(figures[0].svg, "<circle") == 7);
  const Outcomes one = {
      {"sinkage-bionic-toe30-60kg-0.1m_s", outcomes["sinkage-bionic-toe30-60kg-0.1m_s"]}};
  CHECK(draw_figures(one).size() == 1);
}

TEST_CASE("figures and tables by the paper's numbers: what is known of each, nothing guessed") {
  const auto numbers = paper_numbers();
  CHECK(numbers.size() == 4 + 20 + 4);
  CHECK(std::count(numbers.begin(), numbers.end(), "fig9") == 0);
  for (const std::string& name : numbers) {
    if (is_paper_table(name)) continue;
    const std::string about = about_figure(name);
    CHECK(about.starts_with(name + ": "));
    CHECK(about.find('\n') == std::string::npos);
    CHECK(about.find("not known here") != std::string::npos);
  }
  CHECK_THAT(about_figure("fig24"), Catch::Contains("colour map"));
  CHECK_THAT(about_figure("fig25"), !Catch::Contains("colour map"));
}
