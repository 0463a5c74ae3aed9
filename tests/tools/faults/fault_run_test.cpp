// Faults as a user puts them in: the program itself, what it prints, keeps and refuses.

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "tests/tools/experiment/program.h"

using Catch::Contains;
using hoof::tests::Outcome;
using hoof::tests::Program;
using hoof::tests::run_program;
using hoof::tests::ScratchFolder;
using hoof::tools::read_file;
using hoof::tools::write_file;
namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

namespace {

const std::string kExample = HOOF_SOURCE_DIR "/tools/faults/example.toml";

Outcome rigid(const fs::path& out, const Strings& more) {
  Strings arguments = {"sinkage", "--terrain", "rigid", "--quiet", "--out", out.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

}  // namespace

TEST_CASE("the shipped example of faults: each begins, the foot stops, and all of it is told") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  const Outcome outcome = rigid(out, {"--faults", kExample});
  CAPTURE(outcome.errors);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.output, Contains("fault.0 (sync_jitter Sync): from 0.200 s to 0.300 s"));
  CHECK_THAT(outcome.output, Contains("fault.1 (drop ToeReply): from 0.350 s to 0.550 s"));
  CHECK_THAT(outcome.output, Contains("fault.2 (node_silent toe): from "));
  CHECK_THAT(outcome.output, Contains("firmware: drive_lost at "));
  CHECK_THAT(outcome.output, Contains("mode off"));
  const std::string page = read_file(out / "report.html");
  CHECK_THAT(page, Contains("<h2>Faults put in</h2>"));
  CHECK_THAT(page, Contains("fault.2 (node_silent toe)</th><td>"));
  CHECK_THAT(page, Contains("<td>drive_lost</td>"));
  CHECK_THAT(page, Contains("\"marks\":[{\"time_s\":0.2"));
}

TEST_CASE("the same faults give the same bytes, another seed gives others") {
  const ScratchFolder scratch;
  const fs::path first = scratch.path() / "1", second = scratch.path() / "2";
  REQUIRE(rigid(first, {"--faults", kExample}).status == 0);
  REQUIRE(rigid(second, {"--faults", kExample}).status == 0);
  for (const char* name : {"bus.log", "samples.csv", "result.json", "settings.toml"}) {
    CAPTURE(name);
    CHECK(read_file(first / name) == read_file(second / name));
  }
  std::string toml = read_file(kExample);
  const std::size_t seed = toml.find("seed = 7");
  REQUIRE(seed != std::string::npos);
  toml.replace(seed, 8, "seed = 8");
  write_file(scratch.path() / "other.toml", toml);
  const fs::path other = scratch.path() / "3";
  REQUIRE(rigid(other, {"--faults", (scratch.path() / "other.toml").string()}).status == 0);
  CHECK(read_file(first / "bus.log") != read_file(other / "bus.log"));
}

TEST_CASE("a run without faults says nothing of any") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  REQUIRE(rigid(out, {}).status == 0);
  const std::string page = read_file(out / "report.html");
  CHECK_THAT(page, !Contains("Faults put in"));
  CHECK_THAT(page, Contains("\"marks\":[]"));
}

TEST_CASE("faults that cannot be applied end the program before anything is made") {
  struct Case {
    std::string fault, message;
    int status;
  };
  const Case cases[] = {
      {"kind=frob,target=toe,at_s=1", "fault.0.kind = \"frob\": must be one of drop", 2},
      {"kind=drop,target=HipReply,at_s=1", "this rig has no such drive, only toe", 2},
      {"kind=drop,target=toe,when=depth > 1", "no signal 'depth'; there are time_s, tick", 2},
      {"kind=stall,target=toe,at_s=1,friction_Nm=-1", "fault.0.friction_Nm = -1", 2},
      {"kind", "'kind' is not of the form key=value", 2},
      {"kind=drop,target=toe,at_s=3000", "never began: the run ended before", 3},
      {"kind=drop,target=ServiceAnswer,at_s=0.1", "changed nothing", 3},
  };
  for (const Case& c : cases) {
    CAPTURE(c.fault);
    const ScratchFolder scratch;
    const Outcome outcome = rigid(scratch.path() / "run", {"--fault", c.fault});
    CHECK(outcome.status == c.status);
    CHECK_THAT(outcome.errors, Contains(c.message));
    CHECK_FALSE(fs::exists(scratch.path() / "run"));
  }
}

TEST_CASE("the study of faults writes its table three times, the same for any number of jobs") {
  const ScratchFolder scratch;
  const auto study = [&](const char* jobs) {
    const fs::path out = scratch.path() / jobs;
    const Outcome outcome = run_program({"study", "faults", "--mode", "ready", "--only", "e",
                                         "--jobs", jobs, "--out", out.string()});
    CAPTURE(outcome.output, outcome.errors);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.output, Contains("cells, 0 missed"));
    std::string all;
    for (const char* name : {"report.html", "faults.md", "faults.xml"})
      all += read_file(out / name);
    return all;
  };
  CHECK(study("1") == study("3"));
  const Outcome none = run_program({"study", "faults", "--only", "frob", "--out", "x"});
  CHECK(none.status == 2);
}

TEST_CASE("the study of faults can be stopped, and leaves no process behind") {
  const ScratchFolder scratch;
  const Program program({"study", "faults", "--out", (scratch.path() / "out").string()});
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  CHECK(outcome.status == 130);
  CHECK_THAT(outcome.errors, Contains("no table written"));
  CHECK_FALSE(fs::exists(scratch.path() / "out"));
}
