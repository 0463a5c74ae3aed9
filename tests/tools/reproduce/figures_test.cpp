#include "tools/reproduce/figures.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tools/reproduce/paper.h"
#include "tools/reproduce/paper_numbers.h"

using namespace hoof::tools;

namespace {

std::set<Part> all_parts() {
  std::set<Part> parts;
  for (const auto& [name, part] : part_names()) parts.insert(part);
  return parts;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("figures: only of what was run, the paper's numbers dashed beside ours with bars") {
  CHECK(draw_figures({}, all_parts()).empty());
  Outcomes outcomes;
  for (int bed = 1; bed <= 5; ++bed) {
    for (const PaperSinkage& row : paper_sinkages()) {
      outcomes[row.condition][bed].sinkage_mm = row.sinkage_mm * (0.9 + 0.04 * bed);
    }
    for (const PaperTraction& row : paper_tractions()) {
      Outcome& o = outcomes[row.condition][bed];
      o.fx_peak_N = 100, o.fz_at_fx_peak_N = 200, o.coefficient = 0.5 + 0.01 * bed;
      o.trace.fx_N = {0, 50, 100, 50}, o.trace.fz_N = {10, 100, 200, 100};
    }
  }
  const auto figures = draw_figures(outcomes, all_parts());
  std::vector<std::string> names;
  for (const Figure& figure : figures) {
    INFO(figure.name);
    names.push_back(figure.name);
    CHECK(figure.svg.starts_with("<svg"));
    CHECK(count(figure.svg, "stroke-dasharray") > 0);
    CHECK(count(figure.svg, ", paper<") > 0);
    CHECK(count(figure.svg, ", ours<") == count(figure.svg, ", paper<"));
  }
  CHECK(names == std::vector<std::string>{"sinkage-load-0.1m_s", "sinkage-load-0.4m_s",
                                          "sinkage-opening", "traction-coefficient", "traction-fx",
                                          "traction-fz", "traction-fx-time-0.45Hz",
                                          "traction-fz-time-0.45Hz", "traction-fx-time-1.12Hz",
                                          "traction-fz-time-1.12Hz", "traction-opening"});
  // Three feet, two loads each (the spined one has a third from the openings), a bar and mark each.
  CHECK(count(figures[0].svg, "<circle") == 7);
  CHECK(draw_figures(outcomes, {Part::kOpening}).size() == 1);
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
