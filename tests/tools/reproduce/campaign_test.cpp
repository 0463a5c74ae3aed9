// Campaigns as a user runs them, on a rigid floor: whole, killed, damaged, with other settings.
#include "tools/reproduce/campaign.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
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

std::string a_sealed(const fs::path& out) {
  for (const auto& entry : fs::directory_iterator(out / "cells")) {
    if (entry.path().extension() == ".json") return entry.path().stem();
  }
  return "";
}

constexpr int kRuns = 6;  // three feet, two step frequencies

}  // namespace

TEST_CASE("reproduce: killed at any moment the same command goes on, to the same bytes") {
  const std::string jobs = GENERATE("1", "2");
  INFO("--jobs " << jobs);
  const ScratchFolder scratch;
  const fs::path whole = scratch.path() / "whole", cut = scratch.path() / "cut";
  const Outcome undisturbed = run_program(campaign(whole, {"--jobs", "1"}));
  REQUIRE(undisturbed.status == 0);
  CHECK(sealed(whole) == kRuns);
  CHECK_THAT(undisturbed.output,
             Catch::Contains("more targets were not run") && Catch::Contains("geometry of"));

  for (const int after : {1, 3}) {
    const Program program(campaign(cut, {"--jobs", jobs}));
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (sealed(cut) < after && std::chrono::steady_clock::now() < give_up) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    program.send(SIGKILL);
    program.wait();
    REQUIRE(sealed(cut) >= after);
  }
  // With two at once the order in which they end is nobody's.
  const std::string id = jobs == "1" ? "traction-bionic-toe0-0.45Hz-bed1" : a_sealed(cut);
  const auto first = cut / "cells" / id / "result.json";
  REQUIRE(fs::exists(first));
  const auto written = fs::last_write_time(first);
  CHECK(run_program(campaign(cut, {"--jobs", jobs})).status == 0);
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
    CHECK(read_file(first) == read_file(whole / "cells" / id / "result.json"));
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

TEST_CASE("reproduce: the summary is of the folder, whatever part of it a call is about") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "whole";
  const auto part = [&](const std::string& what, const std::string& beds,
                        const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = campaign(out, more, beds);
    arguments[1] = what;
    return run_program(arguments).status;
  };
  const auto targets = [&] {
    std::map<std::string, std::string> results;
    const auto summary = nlohmann::json::parse(read_file(out / "summary.json"));
    for (const auto& t : summary["targets"]) {
      results[t["target"]] = t["result"];
    }
    return results;
  };
  const std::string depth = "sinkage-traditional-40kg-0.1m_s",
                    roll = "table5, roll down an incline";
  REQUIRE(part("load", "2") == 0);
  const std::string sunk = targets().at(depth);
  CHECK(sunk != "not run");
  CHECK(targets().at(roll) == "not run");
  REQUIRE(part("table5", "2") == 0);
  // What only a traction knows, or a box too short for one, is no concern of the sinkages.
  REQUIRE(part("traction", "2", {"--set", "experiment.cycles=1"}) == 0);
  REQUIRE(part("load", "1", {"--set", "bed.box_length_mm=530"}) == 0);
  REQUIRE(part("traction", "2") == 0);
  const auto both = targets();
  CHECK(both.at(depth) == sunk);
  CHECK(both.at("traction-bionic-toe0-0.45Hz, Fx peak") != "not run");
  CHECK(both.count(roll) == 0);
  CHECK(both.at("table5, S2(mu_r), largest difference to table 5") == "inside");
  for (const char* figure : {"sinkage-load-0.1m_s.svg", "traction-fx.svg"}) {
    CHECK(fs::exists(out / "figures" / figure));
  }
  const auto beds = [&] {
    const auto summary = nlohmann::json::parse(read_file(out / "summary.json"));
    for (const auto& t : summary["targets"]) {
      if (t["target"] == depth) return t["ours"]["beds"].get<int>();
    }
    return 0;
  };
  CHECK(beds() == 2);
  REQUIRE(part("traction", "1") == 0);  // of the beds that are asked about
  CHECK(beds() == 1);
}

TEST_CASE("reproduce: told to stop, runs at once stop too, and nothing is left half-written") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "stopped";
  const Program program(campaign(out, {"--jobs", "3"}, "3"));
  while (sealed(out) < 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  program.send(SIGTERM);
  const Outcome stopped = program.wait();
  CHECK(stopped.status == 128 + SIGTERM);
  CHECK_THAT(stopped.errors, Catch::Contains("the same command goes on from there"));
  const int kept = sealed(out);
  CHECK(kept < 3 * kRuns);
  for (const auto& entry : fs::directory_iterator(out / "cells")) {
    CHECK(entry.path().filename().string().front() != '.');
  }
  // Nobody works there any more.
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  CHECK(sealed(out) == kept);
  const Outcome status = run_program({"campaign", "status", out.string()});
  CHECK_THAT(status.output,
             Catch::Contains(std::to_string(kept) + " of 18 runs done, 0 under way"));
}

TEST_CASE("reproduce: one run at a time holds its lock, and leaves what another holds") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "turn";
  const std::string held = "traction-bionic-toe0-1.12Hz-bed1";
  fs::create_directories(out / "locks" / held);
  const tools::FolderLock lock(out / "locks" / held);
  REQUIRE(lock.held());
  const Program program(campaign(out, {"--jobs", "1"}));
  bool seen = false;
  while (sealed(out) < kRuns - 1 && !seen) {
    const Outcome status = run_program({"campaign", "status", out.string()});
    seen = status.output.find("under way  ") != std::string::npos;
  }
  CHECK(seen);
  const Outcome end = program.wait();
  CHECK(end.status == 3);
  CHECK_THAT(end.errors, Catch::Contains(held + ": another process is making it"));
  CHECK(sealed(out) == kRuns - 1);
}

TEST_CASE("claims: runs what is missing over variations, shares the base with reproduce") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "claims";
  REQUIRE(run_program(campaign(out, {}, "2")).status == 0);
  const auto first = out / "cells" / "traction-bionic-toe0-0.45Hz-bed1" / "result.json";
  const auto written = fs::last_write_time(first);
  const std::vector<std::string> claims = {
      "claims", "spines-raise-T", "--terrain", "rigid", "--beds",    "2",
      "--vary", "long-spines",    "--quiet",   "--out", out.string()};
  std::vector<std::string> plan = claims;
  plan.push_back("--plan");
  // Two feet, two steps, two beds; with long spines only the spined foot is another.
  CHECK_THAT(run_program(plan).output, Catch::Contains("12 runs, 8 done"));
  const Outcome judged = run_program(claims);
  CHECK(judged.status == 0);
  CHECK(fs::last_write_time(first) == written);
  const auto j = nlohmann::json::parse(read_file(out / "claims.json"));
  REQUIRE(j["claims"].size() == 1);
  const auto& claim = j["claims"][0];
  REQUIRE(claim["under"].size() == 2);
  CHECK(claim["under"][1]["variation"] == "long-spines");
  for (const auto& under : claim["under"]) {
    for (const auto& contrast : under["contrasts"]) {
      CHECK(contrast["beds"] == std::vector<int>{1, 2});
      CHECK(contrast["runs"].size() == 4);
      for (const std::string id : contrast["runs"]) CHECK(fs::exists(out / "cells" / id));
      // A hard floor is the same on every bed.
      CHECK(contrast["interval95"][0] == contrast["interval95"][1]);
    }
  }
  for (const char* name : {"claims.csv", "claims.html"}) CHECK(fs::exists(out / name));
  // The campaign of the base has the variation's runs as what was tried, and nothing else of them.
  auto before = nlohmann::json::parse(read_file(out / "summary.json"));
  REQUIRE(run_program(campaign(out, {}, "2")).status == 0);
  auto after = nlohmann::json::parse(read_file(out / "summary.json"));
  int tried = 0;
  for (auto& target : after["targets"]) {
    for (const auto& change : target.value("tried", nlohmann::json::array())) {
      CHECK(change["name"] == "long-spines");
      ++tried;
    }
    target.erase("tried"), target.erase("found");
  }
  CHECK(tried > 3);
  CHECK(after == before);
}

TEST_CASE("claims: depth by the sole is shown beside the base, of the same runs") {
  const ScratchFolder scratch;
  const Outcome judged =
      run_program({"claims", "spines-stiffen", "--terrain", "rft", "--beds", "2", "--vary",
                   "valley1", "--quiet", "--out", scratch.path().string()});
  REQUIRE(judged.status == 0);
  const auto j = nlohmann::json::parse(read_file(scratch.path() / "claims.json"));
  const auto& under = j["claims"][0]["under"];
  REQUIRE(under.size() == 3);
  CHECK(under[2]["variation"] == "sole-depth");
  CHECK(under[2]["kind"] == "reading");
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &base = under[0]["contrasts"][i], &reading = under[2]["contrasts"][i];
    CHECK(reading["runs"] == base["runs"]);
    // Less than the way since the spines touched, by 9 mm.
    CHECK(reading["mean"].get<double>() < base["mean"].get<double>());
  }
}

TEST_CASE(
    "reproduce: runs with one thing changed are made when asked for, and counted ever after") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "campaign";
  const Outcome asked =
      run_program(campaign(out, {"--vary", "light-foot", "--vary-beds", "1"}, "2"));
  INFO(asked.output);
  REQUIRE(asked.status == 0);
  CHECK(sealed(out) == 3 * kRuns);  // two beds, and one with it
  const auto of_light_foot = [&] {
    std::istringstream lines(read_file(out / "changes.csv"));
    int count = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.find(",light-foot,") == std::string::npos) continue;
      CHECK_THAT(line, Catch::Contains(",load,") && Catch::Contains("1.1 kg"));
      ++count;
    }
    return count;
  };
  const int told = of_light_foot();
  CHECK(told > 5);
  CHECK_THAT(read_file(out / "report.html"), Catch::Contains("One thing changed"));
  CHECK(run_program(campaign(out, {}, "2")).status == 0);
  CHECK(sealed(out) == 3 * kRuns);
  CHECK(of_light_foot() == told);
  // Of fewer beds than the change was run on: what is not of them does not count.
  CHECK(run_program(campaign(out, {"--seed", "2"}, "1")).status == 0);
  CHECK(of_light_foot() == 0);
}

TEST_CASE("reproduce: a figure that cannot be drawn by its number is one line and an error") {
  const Outcome figure = run_program({"reproduce", "fig25"});
  CHECK(figure.status == 2);
  CHECK_THAT(figure.output, Catch::Contains("fig25: what it shows is not known here"));
  CHECK(run_program({"reproduce", "fig9"}).status == 2);
  const ScratchFolder scratch;
  const Outcome table =
      run_program({"reproduce", "table5", "--quiet", "--out", scratch.path().string()});
  CHECK(table.status == 0);
  CHECK(fs::exists(scratch.path() / "table5" / "report.html"));
}

TEST_CASE("reproduce: a folder of reasons that is no campaign's is told before anything is run") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out", other = scratch.path() / "other";
  fs::create_directories(other);
  const Outcome none = run_program(campaign(out, {"--reasons-from", other.string()}));
  CHECK(none.status == 2);
  CHECK_THAT(none.errors, Catch::Contains((other / "summary.json").string()));
  CHECK_FALSE(fs::exists(out));
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
