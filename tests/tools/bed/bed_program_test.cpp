// hoof bed make, info and export as a user runs them.

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/output_file.h"

using hoof::tests::ScratchFolder;
using hoof::tools::read_file;
using hoof::tools::write_file;
namespace fs = std::filesystem;

namespace {

struct Outcome {
  int status = 0;
  std::string text;
};

Outcome shell(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  Outcome outcome;
  std::array<char, 4096> block;
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), pipe)) > 0) {
    outcome.text.append(block.data(), count);
  }
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

const std::string kBed = HOOF_PROGRAM " bed ";
// The demo's grains in the smallest box they may have: about 1,400, settled in a second.
const std::string kSmall =
    " --threads 1 --set bed.box_length_mm=140 --set bed.box_width_mm=140 --set bed.depth_mm=93";

}  // namespace

TEST_CASE("a bed is made once, described and exported") {
  const ScratchFolder scratch;
  const std::string sides = GENERATE("", " --periodic");
  const fs::path file = scratch.path() / "small.bed";
  const std::string make = kBed + "make --quiet" + kSmall + sides + " --out " + file.string();
  const Outcome made = shell(make);
  REQUIRE(made.status == 0);
  CHECK(made.text.ends_with(file.string() + "\n"));
  CHECK_THAT(made.text, Catch::Contains("coordination number") && Catch::Contains("made in"));
  const std::string bytes = read_file(file);
  const auto time = fs::last_write_time(file);
  CHECK(shell(make).text == made.text);  // found, not made
  CHECK(fs::last_write_time(file) == time);

  const Outcome info = shell(kBed + "info --json " + file.string());
  REQUIRE(info.status == 0);
  const auto json = nlohmann::json::parse(info.text);
  CHECK(json.at("sides") == (sides.empty() ? "walls" : "periodic"));
  CHECK(json.at("box_length_m") == 0.14);
  CHECK(json.at("grains") > 1000);
  CHECK(json.at("grains") < 2000);
  double counted = 0;
  for (const auto& n : json.at("region_grains")) counted += n.get<double>();
  CHECK(counted == json.at("grains").get<double>());
  // A tenth of a thousand and a half of grains is one or two of the largest: 2 % of the mass.
  for (const auto& c : json.at("grading")) {
    CHECK(c.at("got_mass_share").get<double>() ==
          Approx(c.at("wanted_mass_share").get<double>()).margin(0.02));
  }
  CHECK(json.at("making").at("threads") == 1);

  const Outcome exported = shell(kBed + "export " + file.string() + " --every 2 --csv " +
                                 (scratch.path() / "grains.csv").string() + " --vtk " +
                                 (scratch.path() / "vtk").string() + " --foot bionic --toe 20");
  REQUIRE(exported.status == 0);
  const std::string table = read_file(scratch.path() / "grains.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 1 + (json.at("grains").get<int>() + 1) / 2);
  CHECK(fs::exists(scratch.path() / "vtk" / "bed.pvd"));
  CHECK(fs::exists(scratch.path() / "vtk" / "foot-right-00000.vtp"));
  CHECK(read_file(file) == bytes);
}

TEST_CASE("a making that is killed goes on from its checkpoint and ends with the same bytes") {
  const ScratchFolder scratch;
  const fs::path calm = scratch.path() / "calm.bed", killed = scratch.path() / "killed.bed";
  REQUIRE(shell(kBed + "make --quiet" + kSmall + " --out " + calm.string()).status == 0);
  // Killed as soon as there is a checkpoint: while the grains fall.
  const std::string again =
      kBed + "make --checkpoint-every 0" + kSmall + " --out " + killed.string() + " 2>&1";
  const Outcome shot = shell(again + " >/dev/null & job=$!; until ls '" + killed.string() +
                             ".making'/checkpoint-* >/dev/null 2>&1; do sleep 0.01; done; "
                             "kill -9 $job; wait $job");
  CHECK(shot.status == 137);
  REQUIRE_FALSE(fs::exists(killed));
  const Outcome resumed = shell(again);
  CHECK(resumed.status == 0);
  CHECK_THAT(resumed.text, Catch::Contains("going on with the bed 'demo': falling"));
  CHECK(read_file(killed) == read_file(calm));
  CHECK_FALSE(fs::exists(killed.string() + ".making"));
}

TEST_CASE("what is wrong with a bed command is one line and exit status 2") {
  const ScratchFolder scratch;
  const std::string text = (scratch.path() / "text.bed").string();
  write_file(text, "no bed\n");
  const std::string table = (scratch.path() / "sieve.csv").string();
  write_file(table, "aperture_mm,passing_percent\n1,10\n2,99\n");
  struct Case {
    std::string arguments;
    const char* complaint;
  };
  const Case cases[] = {
      {"", "bed: A subcommand is required"},
      {"make --bed absent", "use.bed = \"absent\": must be one of: bench, demo, medium, paper"},
      {"make --threads 0", "--threads: Value 0 not in range"},
      {"make --sieve " + table, "sieve.csv:3: passing_percent = 99.0: must be 100"},
      {"make --sieve-range 1", "--sieve-range: At least 2 required"},
      {"make --out " + text, "text.bed is not a bed file; --force makes it anew"},
      {"make --out /proc/a.bed", "cannot write /proc/a.bed"},
      {"make --set bed.settling_steps_per_ms=20", "bed.settling_steps_per_ms = 20: a step is"},
      {"info", "bed: BED is required"},
      {"info absent", "absent: no such file, and no bed of this name"},
      {"info demo --seed 987654321", "this bed was not made yet; hoof bed make --bed demo"},
      {"info " + text, "text.bed is not a bed file"},
      {"export " + text, "--csv FILE or --vtk DIR is required"},
      {"export " + text + " --csv a.csv --region 1,0,0,1,0,1", "--region: from 1"},
      {"export " + text + " --every 0", "--every: Value 0 not in range"},
      {"export " + text + " --toe 10", "--toe requires --foot"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.arguments);
    const Outcome outcome = shell(kBed + c.arguments + " 2>&1 >/dev/null");
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.text, Catch::StartsWith("hoof: ") && Catch::Contains(c.complaint));
    CHECK(std::count(outcome.text.begin(), outcome.text.end(), '\n') == 1);
  }
}
