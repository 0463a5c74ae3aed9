// The program itself: exit statuses, what it prints and what it leaves behind.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/diagnose/bench.h"
#include "tests/tools/diagnose/data_files.h"
#include "tests/tools/report/browser.h"
#include "tools/run/output_file.h"

using namespace hoof::tests;
using namespace hoof::tools;
namespace fs = std::filesystem;

namespace {

/// Standard output and error together.
ShellOutcome hoof_program(const std::string& arguments) {
  return run_shell(std::string(HOOF_PROGRAM) + " " + arguments + " 2>&1");
}

long lines_of(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

/// Two short recordings of a pendulum, the second held out.
fs::path write_two(const DataFolder& folder) {
  PendulumBench bench;
  bench.length_s = 2;
  bench.step_s = 0.01;
  bench.move_s = 0.05;
  DataSet set = pendulum_bench(bench);
  bench.seed = 2;
  bench.speed_factor = 0.7;
  set.recordings.push_back(pendulum_bench(bench).recordings[0]);
  set.recordings[1].name = "other.csv";
  set.recordings[1].holdout = true;
  return write_bench(set, folder.path());
}

}  // namespace

TEST_CASE("Bad input of diagnose and simulate is one line, status 2, and nothing written") {
  const DataFolder folder;
  folder.write("a.csv", kPendulumCsv);
  folder.write("b.csv", kPendulumCsv);
  const std::string good = folder.write("good.toml", kPendulumToml).string();
  const std::string bad =
      folder.write("bad.toml", replaced(kPendulumToml, "armature", "armatur")).string();
  const std::string held_out =
      folder.write("held_out.toml", replaced(kPendulumToml, "\"fit\"", "\"holdout\"")).string();
  const std::string effects =
      folder.write("f.toml", "format = 1\n[effects.backlash]\ngap = -1\n").string();
  const std::string out = (folder.path() / "out").string();
  struct Case {
    std::string arguments, said;
  };
  const std::vector<Case> cases = {
      {"diagnose " + bad + " --out " + out, "setup.armatur = 0.002: unknown key, did you mean"},
      {"diagnose " + good + " " + bad + " --out " + out, "did you mean armature?"},
      {"diagnose " + held_out + " --out " + out, "at least one must be \"fit\""},
      {"diagnose " + good, "--out is required"},
      {"diagnose --out " + out, "DATASET is required"},
      {"diagnose " + good + " --out " + out + " --threads 0", "--threads"},
      {"diagnose " + good + " --out " + out + " --seed x", "--seed"},
      {"diagnose " + good + " --out " + good, "is not a folder"},
      {"simulate " + bad + " --out " + out, "did you mean armature?"},
      {"simulate " + good + " --effects " + out + ".toml --out " + out, "cannot read"},
      {"simulate " + good + " --effects " + effects + " --out " + out,
       "f.toml:3:1: effects.backlash.gap = -1: must be from"}};
  for (const Case& c : cases) {
    const ShellOutcome outcome = hoof_program(c.arguments);
    INFO(c.arguments << "\n" << outcome.output);
    CHECK(outcome.status == 2);
    CHECK(lines_of(outcome.output) == 1);
    CHECK_THAT(outcome.output, Catch::StartsWith("hoof: ") && Catch::Contains(c.said));
    CHECK_FALSE(fs::exists(out));
  }
}

TEST_CASE("diagnose answers in files and ten lines, alike for any number of threads") {
  const DataFolder folder;
  const std::string set = write_two(folder).string();
  const fs::path one = folder.path() / "one", two = folder.path() / "two";
  const ShellOutcome first =
      hoof_program("diagnose " + set + " --quiet --threads 1 --out " + one.string());
  INFO(first.output);
  REQUIRE(first.status == 0);
  CHECK(lines_of(first.output) == 10);
  CHECK_THAT(first.output, Catch::StartsWith("answer "));
  for (const char* name :
       {"verdict.json", "report.html", "improved.toml", "residuals.csv", "hypotheses.csv"}) {
    CHECK(fs::file_size(one / name) > 0);
  }
  // Two more where it is undecided, and none otherwise.
  const bool open =
      nlohmann::json::parse(read_file(one / "verdict.json")).contains("planned_experiment");
  CHECK(fs::exists(one / "next_experiment.toml") == open);
  CHECK(fs::exists(one / "next_experiment.csv") == open);
  CHECK(std::distance(fs::directory_iterator(one), fs::directory_iterator()) == (open ? 7 : 5));
  REQUIRE(hoof_program("diagnose " + set + " --quiet --threads 2 --out " + two.string()).status ==
          0);
  CHECK(read_file(one / "verdict.json") == read_file(two / "verdict.json"));
  CHECK(read_file(one / "report.html") == read_file(two / "report.html"));
  if (open) CHECK(read_file(one / "next_experiment.csv") == read_file(two / "next_experiment.csv"));
  const ShellOutcome again = hoof_program("diagnose " + set + " --quiet --out " + one.string());
  CHECK(again.status == 2);
  CHECK_THAT(again.output, Catch::Contains("--force replaces it"));

  // The model that was found is the model that is simulated; a stand-in for what is unknown is not.
  CHECK(nlohmann::json::parse(read_file(one / "verdict.json"))["verdict"] != "unknown_physics");
  const fs::path simulated = folder.path() / "simulated";
  const ShellOutcome run =
      hoof_program("simulate " + set + " --effects " + (one / "improved.toml").string() +
                   " --out " + simulated.string());
  INFO(run.output);
  REQUIRE(run.status == 0);
  const auto verdict = nlohmann::json::parse(read_file(one / "verdict.json"));
  const auto result = nlohmann::json::parse(read_file(simulated / "result.json"));
  for (const char* role : {"fit", "holdout"}) {
    for (const auto& [key, value] : verdict["fit"]["after"][role].items()) {
      INFO(role << " " << key);
      CHECK(result[role][key].get<double>() == Approx(value.get<double>()).epsilon(1e-6));
    }
  }
  CHECK_THAT(read_file(simulated / "other.csv"), Catch::StartsWith("time,position,"));
}
