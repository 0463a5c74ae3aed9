// Whole runs of the program on the rigid floor: what they leave behind, and how they end when
// something is in their way.

#include <sys/mount.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "tests/tools/experiment/program.h"

using hoof::tests::Outcome;
using hoof::tests::Program;
using hoof::tests::run_program;
using hoof::tests::ScratchFolder;
using hoof::tools::read_file;
using hoof::tools::write_file;
namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

namespace {

const Strings kFiles = {"bus.log",     "recording.json", "report.html",   "result.json",
                        "samples.csv", "settings.toml",  "telemetry.lcm", "timing.json"};

Strings rigid(const std::string& experiment, const fs::path& out, const Strings& more = {}) {
  Strings arguments = {experiment, "--terrain", "rigid", "--quiet", "--out", out.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Strings names_in(const fs::path& folder) {
  Strings names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool is_one_line(const std::string& text) {
  return !text.empty() && text.back() == '\n' && std::count(text.begin(), text.end(), '\n') == 1;
}

/// A stance after the other: long enough to be disturbed (several seconds of computing).
Strings long_run(const fs::path& out) {
  return rigid("traction", out, {"--set", "experiment.cycles=100"});
}

/// Until the run has written some of its log; a run that has not begun has nothing to lose.
void wait_until_under_way(const fs::path& folder) {
  for (int i = 0; i < 2000; ++i) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      std::error_code error;
      if (fs::file_size(entry.path() / "bus.log", error) > 10'000 && !error) return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  FAIL("the run does not get under way");
}

/// A full disk in little: 64 KiB of memory, mounted for the life of this object.
class TinyDisk {
 public:
  TinyDisk() { mounted_ = mount("tmpfs", path().c_str(), "tmpfs", 0, "size=64k") == 0; }
  ~TinyDisk() {
    if (mounted_) umount(path().c_str());
  }
  TinyDisk(const TinyDisk&) = delete;
  TinyDisk& operator=(const TinyDisk&) = delete;
  bool mounted() const { return mounted_; }
  const fs::path& path() const { return scratch_.path(); }

 private:
  ScratchFolder scratch_;
  bool mounted_ = false;
};

}  // namespace

TEST_CASE("both tests finish for all three feet and leave one whole folder") {
  for (const std::string experiment : {"sinkage", "traction"}) {
    for (const std::string foot : {"bionic", "bionic-plain", "traditional"}) {
      CAPTURE(experiment, foot);
      const ScratchFolder scratch;
      const fs::path out = scratch.path() / "run";
      const Outcome outcome = run_program(rigid(experiment, out, {"--foot", foot}));
      CHECK(outcome.status == 0);
      CHECK(outcome.errors.empty());
      CHECK_THAT(outcome.output, Catch::EndsWith("\n" + out.string() + "\n"));
      CHECK(names_in(scratch.path()) == Strings{"run"});
      CHECK(names_in(out) == kFiles);
    }
  }
}

TEST_CASE("the same command twice gives the same bytes") {
  for (const std::string experiment : {"sinkage", "traction"}) {
    const ScratchFolder scratch;
    const fs::path first = scratch.path() / "first", second = scratch.path() / "second";
    REQUIRE(run_program(rigid(experiment, first)).status == 0);
    REQUIRE(run_program(rigid(experiment, second)).status == 0);
    for (const char* name : {"bus.log", "samples.csv", "result.json", "settings.toml"}) {
      CAPTURE(experiment, name);
      CHECK(read_file(first / name).size() > 500);
      CHECK(read_file(first / name) == read_file(second / name));
    }
    // And another opening gives others.
    const fs::path other = scratch.path() / "other";
    REQUIRE(run_program(rigid(experiment, other, {"--toe", "25"})).status == 0);
    CHECK(read_file(first / "bus.log") != read_file(other / "bus.log"));
  }
}

TEST_CASE("an earlier result is not overwritten without --force") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  REQUIRE(run_program(rigid("sinkage", out)).status == 0);
  const std::string before = read_file(out / "result.json");
  const Outcome refused = run_program(rigid("sinkage", out, {"--toe", "30"}));
  CHECK(refused.status == 2);
  CHECK(refused.errors ==
        "hoof: --out " + out.string() + ": exists already (--force replaces it)\n");
  CHECK(read_file(out / "result.json") == before);
  CHECK(run_program(rigid("sinkage", out, {"--toe", "30", "--force"})).status == 0);
  CHECK(read_file(out / "result.json") != before);
  CHECK(names_in(scratch.path()) == Strings{"run"});
}

TEST_CASE("bad input ends with status 2 and leaves nothing behind") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  const std::vector<Strings> cases = {{"--set", "experiment.toe_deg=55"},
                                      {"--set", "bed.nothing=1"},
                                      {"--set", "control.toe_kp_Nm_rad=1000"},
                                      {"--foot", "traditional", "--toe", "20"},
                                      {"--foot", "nothing.stl"},
                                      {"--set", "coupling.exchange_us=70"}};
  for (const Strings& more : cases) {
    CAPTURE(more);
    const Outcome outcome = run_program(rigid("sinkage", out, more));
    CHECK(outcome.status == 2);
    CHECK(is_one_line(outcome.errors));
    CHECK(outcome.output.empty());
    CHECK(names_in(scratch.path()).empty());
  }
}

TEST_CASE("a folder that cannot be made is told at once") {
  const ScratchFolder scratch;
  write_file(scratch.path() / "file", "");
  const Outcome outcome = run_program(rigid("sinkage", scratch.path() / "file/run"));
  CHECK(outcome.status == 2);
  CHECK(is_one_line(outcome.errors));
  CHECK_THAT(outcome.errors, Catch::Contains("cannot make this folder: Not a directory"));
}

TEST_CASE("a bus that is not there is one line with its cure") {
  const ScratchFolder scratch;
  const Outcome outcome =
      run_program(rigid("sinkage", scratch.path() / "run", {"--bus", "nocan7"}));
  CHECK(outcome.status == 3);
  CHECK(is_one_line(outcome.errors));
  CHECK_THAT(outcome.errors, Catch::StartsWith("hoof: nocan7: "));
  CHECK(names_in(scratch.path()).empty());
}

TEST_CASE("Ctrl-C keeps what there is, readable, under a name that says so") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  const Program program(long_run(out));
  wait_until_under_way(scratch.path());
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  const fs::path kept = scratch.path() / "run-interrupted";
  CHECK(outcome.status == 130);
  CHECK(outcome.errors ==
        "hoof: stopped; the results up to that moment are kept in " + kept.string() + "\n");
  CHECK(names_in(scratch.path()) == Strings{"run-interrupted"});
  CHECK(names_in(kept) == kFiles);
  for (const char* name : {"bus.log", "samples.csv", "result.json"}) {
    CHECK(read_file(kept / name).back() == '\n');  // whole lines
  }
  CHECK(run_program({"report", kept.string()}).status == 0);
}

TEST_CASE("a killed run leaves nothing that looks like a result") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  const Program program(long_run(out));
  wait_until_under_way(scratch.path());
  program.send(SIGKILL);
  CHECK(program.wait().status == -SIGKILL);
  CHECK_FALSE(fs::exists(out));
  for (const std::string& name : names_in(scratch.path())) CHECK(name.front() == '.');
  // Nor is it in the way of the next one, which clears it away.
  CHECK(run_program(rigid("sinkage", out)).status == 0);
  CHECK(names_in(scratch.path()) == Strings{"run"});
}

TEST_CASE("a file that cannot grow ends the run with status 2 and nothing half-written") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  // A limit of the process instead of the disk's: it needs no rights.
  const Outcome outcome = Program(rigid("sinkage", out), 20'000).wait();
  CHECK(outcome.status == 2);
  CHECK(is_one_line(outcome.errors));
  CHECK_THAT(outcome.errors, Catch::Contains("cannot write") && Catch::Contains("File too large"));
  CHECK(names_in(scratch.path()).empty());
}

TEST_CASE("a full disk ends the run with status 2 and nothing half-written") {
  const TinyDisk disk;
  if (!disk.mounted()) {
    WARN("SKIPPED, NOT TESTED: mounting a small disk needs root");
    return;
  }
  const Outcome outcome = run_program(rigid("sinkage", disk.path() / "run"));
  CHECK(outcome.status == 2);
  CHECK(is_one_line(outcome.errors));
  CHECK_THAT(outcome.errors,
             Catch::Contains("cannot write") && Catch::Contains("No space left on device"));
  CHECK(names_in(disk.path()).empty());
}
