// Campaigns as a user runs them, on a rigid floor: whole, killed, damaged, with other settings.
#include "tools/reproduce/campaign.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/tools/experiment/program.h"
#include "tests/tools/run/scratch_folder.h"

using namespace hoof;
using namespace hoof::tests;
namespace fs = std::filesystem;
using tools::read_file;

namespace {

std::vector<std::string> campaign(const fs::path& out, std::vector<std::string> more = {},
                                  const std::string& beds = "1") {
  std::vector<std::string> arguments = {"reproduce", "traction", "--terrain", "rigid",     "--beds",
                                        beds,        "--quiet",  "--out",     out.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Runs that are sealed.
int sealed(const fs::path& out) {
  int count = 0;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(out / "cells", none)) {
    count += entry.path().extension() == ".json" ? 1 : 0;
  }
  return count;
}

constexpr int kRuns = 6;  // three feet, two step frequencies

}  // namespace

TEST_CASE("reproduce: killed at any moment the same command goes on, to the same bytes") {
  const ScratchFolder scratch;
  const fs::path whole = scratch.path() / "whole", cut = scratch.path() / "cut";
  const Outcome undisturbed = run_program(campaign(whole));
  REQUIRE(undisturbed.status == 0);
  CHECK(sealed(whole) == kRuns);
  CHECK_THAT(undisturbed.output,
             Catch::Contains("more targets were not run") && Catch::Contains("geometry of"));

  for (const int after : {1, 3}) {
    const Program program(campaign(cut));
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (sealed(cut) < after && std::chrono::steady_clock::now() < give_up) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    program.send(SIGKILL);
    program.wait();
    REQUIRE(sealed(cut) >= after);
  }
  const auto first = cut / "cells" / "traction-bionic-toe0-0.45Hz-bed1" / "result.json";
  REQUIRE(fs::exists(first));
  const auto written = fs::last_write_time(first);
  CHECK(run_program(campaign(cut)).status == 0);
  CHECK(fs::last_write_time(first) == written);  // what was done is not done again
  for (const char* name : {"summary.json", "summary.csv"}) {
    CHECK(read_file(cut / name) == read_file(whole / name));
  }
  // Nothing but what an undisturbed campaign leaves.
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(cut / "cells")) {
    left += entry.path().filename().string().front() == '.' ? 1 : 0;
  }
  CHECK(left == 0);

  SECTION("a result that was changed is run again") {
    tools::write_file(first, "{\"traction_coefficient\": 9}\n");
    CHECK(run_program(campaign(cut)).status == 0);
    CHECK(read_file(first) ==
          read_file(whole / "cells" / "traction-bionic-toe0-0.45Hz-bed1" / "result.json"));
  }
  SECTION("a run that was not sealed when the program was killed is sealed, not run again") {
    const fs::path seal = first.parent_path().string() + ".json";
    const std::string before = read_file(seal);
    fs::remove(seal);
    CHECK(run_program(campaign(cut)).status == 0);
    CHECK(fs::last_write_time(first) == written);
    CHECK(read_file(seal) == before);
  }
  SECTION("other settings are refused in one line that names the key") {
    const Outcome other = run_program(campaign(cut, {"--set", "experiment.cycles=2"}));
    CHECK(other.status == 2);
    CHECK_THAT(other.errors, Catch::Contains("experiment.cycles is 1 there and 2 now"));
  }
  SECTION("the plan says what is done") {
    const Outcome plan = run_program(campaign(cut, {"--plan"}));
    CHECK(plan.status == 0);
    CHECK_THAT(plan.output, Catch::Contains("6 runs, 6 done"));
    const Outcome more = run_program(campaign(cut, {"--plan"}, "2"));
    CHECK_THAT(more.output, Catch::Contains("12 runs, 6 done"));
  }
}

TEST_CASE("reproduce: one campaign, one process") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "one";
  fs::create_directories(out);
  const tools::FolderLock lock(out);
  REQUIRE(lock.held());
  const Outcome second = run_program(campaign(out));
  CHECK(second.status == 2);
  CHECK_THAT(second.errors, Catch::Contains("another process is working on this campaign"));
}
