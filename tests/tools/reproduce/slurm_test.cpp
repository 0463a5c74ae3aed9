// Campaigns over a real Slurm: the same bytes as on one machine, whatever Slurm forgets.
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/tools/experiment/program.h"
#include "tests/tools/reproduce/private_slurm.h"
#include "tools/reproduce/run_store.h"

using namespace hoof;
using namespace hoof::tests;
namespace fs = std::filesystem;
using tools::read_file;

namespace {

constexpr int kRuns = 6;  // three feet, two step frequencies

std::vector<std::string> campaign(const fs::path& out, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"reproduce", "traction", "--terrain", "rigid",     "--beds",
                                        "1",         "--quiet",  "--out",     out.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> by_slurm(const fs::path& out, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"--engine", "slurm", "--poll", "0.2"});
  return campaign(out, more);
}

int sealed(const fs::path& out) {
  int count = 0;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(out / "cells", none)) {
    count += entry.path().extension() == ".json" ? 1 : 0;
  }
  return count;
}

std::vector<nlohmann::json> submissions(const fs::path& out) {
  const fs::path file = out / "slurm" / "submissions.json";
  if (!fs::exists(file)) return {};
  return nlohmann::json::parse(read_file(file)).get<std::vector<nlohmann::json>>();
}

bool skipped() {
  if (PrivateSlurm::installed()) return false;
  WARN("NOT RUN: slurmctld, slurmd and slurm-client are not installed (tools/packages.txt, test)");
  return true;
}

/// Beds are kept for all runs; one made for a test alone is of no use to others.
struct ThrownAway {
  std::string part_of_name;
  ~ThrownAway() {
    std::error_code none;
    std::vector<fs::path> found;
    for (const auto& entry :
         fs::directory_iterator(fs::path(HOOF_SOURCE_DIR) / ".cache/beds", none)) {
      if (entry.path().filename().string().find(part_of_name) != std::string::npos) {
        found.push_back(entry.path());
      }
    }
    for (const fs::path& path : found) fs::remove_all(path, none);
  }
};

/// A run has moved sand, in the hidden folder that it grows in: stopped before, it would leave
/// nothing to go on from.
bool records(const fs::path& cells) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(cells, none)) {
    const bool hidden = entry.path().filename().string().front() == '.';
    const fs::path samples = entry.path() / "samples.csv";
    if (hidden && fs::exists(samples, none)) {
      return read_file(samples).find(",loaded,") != std::string::npos;
    }
  }
  return false;
}

/// How often a run was tried, by its own account.
int tries(const fs::path& out, const std::string& id) {
  return tools::RunStore(out).attempt(id).value_or(tools::Attempt{}).tries;
}

}  // namespace

TEST_CASE("slurm: a campaign over array jobs has the bytes of one on this machine") {
  if (skipped()) return;
  const ScratchFolder scratch;
  const fs::path local = scratch.path() / "local", cluster = scratch.path() / "a 'cluster'";
  REQUIRE(run_program(campaign(local)).status == 0);
  const PrivateSlurm slurm;
  const Outcome outcome = run_program(by_slurm(cluster, {"--wait", "--at-once", "2"}));
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  CHECK(sealed(cluster) == kRuns);
  for (const char* name : {"summary.json", "summary.csv"}) {
    CHECK(read_file(cluster / name) == read_file(local / name));
  }
  for (const auto& entry : fs::directory_iterator(local / "cells")) {
    const fs::path id = entry.path().filename();
    if (!entry.is_directory()) continue;
    for (const char* file : {"result.json", "samples.csv", "bus.log"}) {
      CHECK(read_file(cluster / "cells" / id / file) == read_file(local / "cells" / id / file));
    }
  }
  const Outcome status = run_program({"campaign", "status", cluster.string()});
  CHECK_THAT(status.output, Catch::Contains("6 of 6 runs done, 0 under way"));
  // Nothing is submitted a second time.
  CHECK(run_program(by_slurm(cluster)).status == 0);
  slurm.until_empty();
  for (const auto& entry : fs::directory_iterator(cluster / "attempts")) {
    CHECK(tries(cluster, entry.path().stem()) == 1);
  }
}

TEST_CASE("slurm: the controller killed, jobs lost, a run made twice: the next call reconciles") {
  if (skipped()) return;
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "campaign";
  PrivateSlurm slurm;
  // One at a time, so that most of the array still waits.
  const Outcome begun = run_program(by_slurm(out, {"--at-once", "1"}));
  REQUIRE(begun.status == 0);
  CHECK_THAT(begun.output, Catch::Contains("runs are in the cluster's queue or under way"));
  REQUIRE(submissions(out).size() == 1);
  CHECK(submissions(out)[0]["runs"].size() == kRuns);

  // While it is there the same call submits nothing.
  const std::string name = submissions(out)[0]["name"];
  CHECK(run_program(by_slurm(out)).status == 0);
  for (const auto& s : submissions(out)) CHECK(s["name"] == name);

  while (sealed(out) < 1) PrivateSlurm::pause_ms(5);
  slurm.kill_controller();
  // Nothing is known of the queue now: nothing is submitted, and that is said.
  const Outcome blind = run_program(by_slurm(out));
  CHECK(blind.status == 3);
  CHECK_THAT(blind.errors, Catch::Contains("squeue failed"));
  CHECK(submissions(out).size() == 1);
  slurm.start_controller(true);  // and has forgotten all

  // A run made twice, at once: another process of the same program, with no word from Slurm.
  const std::string twice = "traction-traditional-1.12Hz-bed1";
  const Program beside({"campaign", "run", out.string(), twice, "--quiet"});
  const Outcome again = run_program(by_slurm(out, {"--wait"}));
  INFO(again.errors);
  CHECK(again.status == 0);
  CHECK(beside.wait().status == 0);
  CHECK(sealed(out) == kRuns);
  const fs::path local = scratch.path() / "local";
  REQUIRE(run_program(campaign(local)).status == 0);
  CHECK(read_file(out / "summary.json") == read_file(local / "summary.json"));

  SECTION("a result lost after its job is submitted again, alone") {
    fs::remove_all(out / "cells" / twice);
    CHECK(run_program(by_slurm(out)).status == 0);
    std::set<std::string> sent;
    for (const auto& s : submissions(out)) {
      for (const auto& id : s["runs"]) sent.insert(id.get<std::string>());
    }
    CHECK(sent == std::set<std::string>{twice});
    CHECK(run_program(by_slurm(out, {"--wait"})).status == 0);
    CHECK(read_file(out / "summary.json") == read_file(local / "summary.json"));
  }
}

TEST_CASE("slurm: a job told that its time is over stops with a checkpoint, the next goes on") {
  if (skipped()) return;
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "grains";
  // Some 3,000 grains and a bed that nobody has made.
  const std::string seed = std::to_string(900000 + getpid() % 90000);
  const ThrownAway bed{"-" + seed + "-"};
  std::vector<std::string> small = {"--terrain", "dem", "--seed", seed};
  for (const char* setting : {"bed.box_length_mm=240", "bed.box_width_mm=200", "bed.depth_mm=93",
                              "experiment.time_limit_s=0.08"}) {
    small.insert(small.end(), {"--set", setting});
  }
  const auto load = [&](const fs::path& folder, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"reproduce", "fig5",    "load",  "--beds",
                                          "1",         "--quiet", "--out", folder.string()};
    arguments.insert(arguments.end(), small.begin(), small.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const PrivateSlurm slurm;
  REQUIRE(run_program(load(out, {"--engine", "slurm", "--at-once", "1"})).status == 0);
  // Beds first, one job; then the runs.
  REQUIRE(submissions(out).size() == 2);
  CHECK(submissions(out)[0]["beds"] == true);
  CHECK(submissions(out)[0]["runs"].size() == 1);
  const std::string first = submissions(out)[1]["runs"][0];
  while (!records(out / "cells")) PrivateSlurm::pause_ms(2);
  const std::string job = submissions(out).back()["job"];
  // As Slurm sends it --stop-ahead seconds before the limit: to the batch shell, whose place hoof
  // has taken.
  const std::string where = tools::RunStore(out).attempt(first)->where;
  INFO(where);
  REQUIRE(kill(std::stoi(where.substr(where.find("process ") + 8)), SIGUSR1) == 0);
  PrivateSlurm::run("scancel --state=PENDING " + job);
  slurm.until_empty();
  const auto attempt = tools::RunStore(out).attempt(first);
  REQUIRE(attempt);
  CHECK(attempt->state == "stopped");
  CHECK(fs::exists(out / "cells" / (first + ".resume")));
  const Outcome status = run_program({"campaign", "status", out.string()});
  CHECK_THAT(status.output, Catch::Contains("stopped    " + first));

  // The next job goes on and ends with the bytes of an undisturbed run.
  REQUIRE(run_program({"campaign", "run", out.string(), first, "--quiet"}).status == 0);
  CHECK_FALSE(fs::exists(out / "cells" / (first + ".resume")));
  CHECK(tries(out, first) == 2);
  const fs::path whole = scratch.path() / "whole";
  std::vector<std::string> alone = {"sinkage", "--quiet", "--out", whole.string()};
  const auto manifest = nlohmann::json::parse(read_file(out / "manifest.json"));
  for (const std::string setting : manifest["runs"][0]["settings"]) {
    alone.push_back("--set");
    alone.push_back(setting);
  }
  REQUIRE(run_program(alone).status == 0);
  for (const char* file : {"result.json", "samples.csv", "bus.log"}) {
    CHECK(read_file(whole / file) == read_file(out / "cells" / first / file));
  }
}
