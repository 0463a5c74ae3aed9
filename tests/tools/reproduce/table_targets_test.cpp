#include "tools/reproduce/table_targets.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;

TEST_CASE("tables: those that are not there are not run, the others' targets have their bands") {
  const hoof::tests::ScratchFolder scratch;
  const auto none = table_targets(scratch.path());
  REQUIRE(none.size() == 4);
  for (const Comparison& row : none) CHECK(row.judgement() == Judgement::kNotRun);

  std::filesystem::create_directories(scratch.path() / "table4");
  write_file(scratch.path() / "table4" / "result.json",
             R"({"targets": [
  {"name": "tilt", "unit": "deg", "paper": 30.9, "low": 30, "high": 31, "ours": 31.2},
  {"name": "most off", "unit": "deg", "paper": null, "low": null, "high": 0.4, "ours": 0.1},
  {"name": "blocked", "unit": "deg", "paper": null, "low": null, "high": 0.4, "ours": null},
  {"name": "scatter", "unit": "deg", "paper": null, "low": null, "high": null, "ours": 0.5}]})");
  const auto rows = table_targets(scratch.path());
  REQUIRE(rows.size() == 3 + 3);
  CHECK(rows[2].name == "table4, tilt");
  CHECK(rows[2].paper == 30.9);
  CHECK(rows[2].judgement() == Judgement::kOutside);
  CHECK(rows[3].judgement() == Judgement::kInside);
  CHECK(std::isnan(rows[3].paper));
  CHECK(rows[4].judgement() == Judgement::kUndefined);
  // Each laboratory has something that its table set.
  for (const Comparison& row : rows) CHECK(row.standing == Standing::kInput);

  write_file(scratch.path() / "table4" / "result.json", "{\"targets\": [{}]}");
  CHECK_THROWS_AS(table_targets(scratch.path()), UserError);
}
