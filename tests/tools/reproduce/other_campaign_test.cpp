#include "tools/reproduce/other_campaign.h"

#include <catch2/catch.hpp>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;

namespace {

Comparison target(const char* name, double ours) {
  Comparison row;
  row.name = name, row.paper = 1, row.low = 0.9, row.high = 1.1;
  row.ours = Sample{.n = 5, .mean = ours};
  return row;
}

}  // namespace

TEST_CASE("another campaign tells of what is outside here: inside there, or what takes it inside") {
  const hoof::tests::ScratchFolder scratch;
  write_file(scratch.path() / "summary.json",
             R"({"scale": "medium", "terrain": "dem", "targets": [
  {"target": "a", "result": "inside", "ours": {"mean": 1.0625, "beds": 5}},
  {"target": "b", "result": "outside", "found": "inside by load (block-load): 1.05 ..."},
  {"target": "c", "result": "outside"},
  {"target": "d", "result": "inside", "ours": {"mean": 1.0, "beds": 1}},
  {"target": "e", "result": "not run"},
  {"target": "unknown here", "result": "inside", "ours": {"mean": 1.0, "beds": 1}}]})");
  std::vector<Comparison> rows = {target("a", 2), target("b", 2), target("c", 2),
                                  target("d", 1), target("e", 2), target("only here", 2)};
  ask_other_campaign(rows, scratch.path());
  CHECK(rows[0].reasons() == "on medium, 5 beds, inside as it is: 1.06");
  CHECK(rows[1].reasons() == "on medium inside by load (block-load): 1.05 ...");
  // Nothing was found there, it is inside here, it was not run there, it is not known there.
  for (const std::size_t i : {2, 3, 4, 5}) CHECK(rows[i].reasons().empty());
  // Runs that both have are told once.
  rows[2].tried.push_back(
      {"path", "deeper-path", "", Sample{.n = 1, .mean = 1.0}, Sample{.n = 1, .mean = 2.0}, true});
  const std::string same = rows[2].found();
  write_file(scratch.path() / "summary.json",
             R"({"scale": "medium", "terrain": "dem", "targets": [
  {"target": "c", "result": "outside", "found": ")" +
                 same + R"("}]})");
  ask_other_campaign(rows, scratch.path());
  CHECK(rows[2].reasons() == same);
  // Beside what was found here.
  rows[1].tried.push_back(
      {"path", "deeper-path", "", Sample{.n = 1, .mean = 1.0}, Sample{.n = 1, .mean = 2.0}, true});
  CHECK(rows[1].found().starts_with("inside by path (deeper-path): 1 in place of 2"));
  CHECK(rows[1].reasons() == rows[1].found() + "; " + rows[1].elsewhere);
}

TEST_CASE("another campaign that is none, or of no grains, is an error that names the file") {
  const hoof::tests::ScratchFolder scratch;
  std::vector<Comparison> rows = {target("a", 2)};
  const auto complaint = [&](const char* text) -> std::string {
    if (*text != 0) write_file(scratch.path() / "summary.json", text);
    try {
      ask_other_campaign(rows, scratch.path());
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  };
  for (const char* text : {"", "{", "[]", R"({"scale": "demo", "terrain": "dem"})",
                           R"({"scale": "demo", "terrain": "dem", "targets": [{"target": 3}]})"}) {
    INFO(text);
    CHECK_THAT(complaint(text), Catch::Contains("summary.json: "));
  }
  CHECK_THAT(complaint(R"({"scale": "demo", "terrain": "rft", "targets": []})"),
             Catch::EndsWith("terrain is rft, and only grains tell of grains"));
}
