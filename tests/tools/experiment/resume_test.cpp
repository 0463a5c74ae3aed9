// Runs of the program in grains that are killed and gone on with: they end with the bytes of the
// run that nobody disturbed.

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <map>
#include <thread>

#include "sim/terrain/random.h"
#include "tests/tools/experiment/program.h"
#include "tests/tools/experiment/test_sand.h"

using hoof::tests::joined;
using hoof::tests::on_test_sand;
using hoof::tests::Outcome;
using hoof::tests::Program;
using hoof::tests::run_program;
using hoof::tests::ScratchFolder;
using hoof::tests::Strings;
using hoof::tools::read_file;
using hoof::tools::write_file;
namespace fs = std::filesystem;

namespace {

/// The first 25 ms after the contact: 2,000 bed steps.
const Strings kBrief = {"experiment.time_limit_s=0.025"};
/// 18 ms by the clock: many checkpoints in a run, however fast the sand is.
const Strings kCheckpoints = {"--checkpoint-every", "0.0003"};

Strings command(const fs::path& out) {
  return joined({"sinkage", "--threads", "1", "--fields", "vtk", "--out", out.string()},
                on_test_sand(kBrief));
}

Strings anew(const fs::path& out) {
  return joined(command(out), kCheckpoints);
}

Strings resumed(const fs::path& out) {
  return joined({"sinkage", "--resume", out.string() + ".resume"}, kCheckpoints);
}

/// By number, so that the last is the newest.
std::map<int, fs::path> checkpoints(const fs::path& out) {
  const std::string kName = "checkpoint-";
  std::map<int, fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(out.string() + ".resume", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kName) && !name.ends_with(".part")) {
      found[std::stoi(name.substr(kName.size()))] = entry.path();
    }
  }
  return found;
}

int newest(const fs::path& out) {
  const auto found = checkpoints(out);
  return found.empty() ? 0 : found.rbegin()->first;
}

void sleep_ms(double ms) {
  std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms));
}

/// Starts the program and ends it with a signal some time after its next checkpoint.
Outcome disturb(const Strings& arguments, const fs::path& out, int signal_number, double delay_ms) {
  const int before = newest(out);
  const Program program(arguments);
  // Ten times as long as the slowest machine should need; a run that ends first is told below.
  for (int i = 0; i < 6000 && newest(out) == before && !fs::exists(out); ++i) sleep_ms(5);
  sleep_ms(delay_ms);
  program.send(signal_number);
  return program.wait();
}

void check_same(const fs::path& undisturbed, const fs::path& out) {
  for (const char* name : {"bus.log", "samples.csv", "result.json", "telemetry.lcm",
                           "settings.toml", "section.svg", "fields.json", "fields/view.json",
                           "fields/greatest_depth-chains.svg", "fields/contacts-00002.vtp"}) {
    CAPTURE(name);
    CHECK(read_file(undisturbed / name).size() > 500);
    CHECK(read_file(undisturbed / name) == read_file(out / name));
  }
}

Strings names_in(const fs::path& folder) {
  Strings names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE("a run killed at any moment ends with the same bytes as the undisturbed run") {
  const ScratchFolder scratch;
  const fs::path undisturbed = scratch.path() / "undisturbed", out = scratch.path() / "run";
  REQUIRE(run_program(command(undisturbed)).status == 0);

  const std::uint64_t seed = 4711;
  CAPTURE(seed);
  hoof::sim::Random random(seed);
  // The first anywhere from the start of the process on: perhaps nothing is there yet.
  {
    const Program program(anew(out));
    sleep_ms(random.between(0, 400));
    program.send(SIGKILL);
    CHECK(program.wait().status == -SIGKILL);
    CHECK_FALSE(fs::exists(out));
  }
  for (int kill = 0; kill < 3; ++kill) {
    CAPTURE(kill);
    const bool begun = newest(out) > 0;
    const Outcome killed =
        disturb(begun ? resumed(out) : anew(out), out, SIGKILL, random.between(0, 20));
    REQUIRE(killed.status == -SIGKILL);
    CHECK_FALSE(fs::exists(out));
  }

  // It is not begun anew by mistake.
  const Outcome refused = run_program(anew(out));
  CHECK(refused.status == 2);
  CHECK_THAT(refused.errors, Catch::Contains("a run of this name was not finished; to finish it: "
                                             "hoof sinkage --resume "));
  // Ctrl-C says how to go on.
  const Outcome stopped = disturb(resumed(out), out, SIGINT, 0);
  CHECK(stopped.status == 130);
  CHECK_THAT(stopped.errors, Catch::EndsWith("; to finish the run: hoof sinkage --resume " +
                                             out.string() + ".resume\n"));
  CHECK(fs::exists(out.string() + "-interrupted/result.json"));
  fs::remove_all(out.string() + "-interrupted");
  // With the newest checkpoint damaged it goes on from the one before.
  const auto found = checkpoints(out);
  REQUIRE(found.size() == 2);
  const fs::path damaged = found.rbegin()->second;
  std::string bytes = read_file(damaged);
  bytes[bytes.size() / 2] ^= 4;
  write_file(damaged, bytes);
  const Outcome finished = run_program({"sinkage", "--resume", out.string()});
  INFO(finished.errors);
  CHECK(finished.status == 0);
  CHECK_THAT(finished.errors,
             Catch::Contains("hoof: " + damaged.string() +
                             " is damaged: its checksum does not match; it is not used\n"
                             "hoof: going over what was done, up to the checkpoint at "));
  check_same(undisturbed, out);
  CHECK(names_in(scratch.path()) == Strings{"run", "undisturbed"});
}
