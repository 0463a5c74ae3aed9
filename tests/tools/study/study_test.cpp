// The studies as a user starts them, on the coarsest grains that fit their boxes.

#include "tools/study/study.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <sstream>

#include "tests/tools/run/scratch_folder.h"
#include "tools/cli/commands.h"
#include "tools/report/sample_table.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
using hoof::tests::ScratchFolder;

namespace {

/// What a study prints.
std::string printed(void (*study)(const StudyOptions&), const StudyOptions& options) {
  std::ostringstream text;
  std::streambuf* const console = std::cout.rdbuf(text.rdbuf());
  try {
    study(options);
  } catch (...) {
    std::cout.rdbuf(console);
    throw;
  }
  std::cout.rdbuf(console);
  return text.str();
}

/// 1,100 grains, pressed fast with long steps: seconds.
StudyOptions coarse(const ScratchFolder& scratch) {
  StudyOptions options;
  options.out = scratch.path() / "study";
  options.beds = scratch.path() / "beds";
  options.bed_count = 1;
  options.threads = 1;
  options.scales = {3.6};
  options.lengths_mm = {140};
  options.settings = {"bed.steps_per_ms=180", "experiment.speed_m_s=0.8"};
  options.quiet = true;
  return options;
}

/// Parses a command line of `hoof`; the study is not run.
void parse(const std::string& line) {
  CLI::App app;
  Invocation invocation;
  add_study_command(app, invocation);
  app.parse(line);
  CHECK(bool(invocation.run));
}

}  // namespace

TEST_CASE(
    "the resolution study pairs plain and spined in the same beds, and goes on where it was") {
  const ScratchFolder scratch;
  StudyOptions options = coarse(scratch);
  const std::string first = printed(run_resolution_study, options);
  CHECK_THAT(first, Catch::Contains("beds of seeds 1 to 1") &&
                        Catch::Contains("Pressed at 0.8 m/s, step 5.56 us times the grain scale"));
  const SampleTable table = read_samples(options.out / "resolution.csv");
  REQUIRE(table.find("depth_mm") != nullptr);
  CHECK(table.find("depth_mm")->numbers == std::vector<double>{5, 8, 13});
  CHECK(table.find("effect_name")->texts.front() == "spines");
  for (const double pressure_Pa : table.find("pressure_Pa")->numbers) CHECK(pressure_Pa > 0);
  for (const double share : table.find("solid_share_ratio")->numbers) {
    CHECK(share > 0.5);
    CHECK(share < 0.66);
  }
  // One bed has no scatter, so it resolves nothing.
  for (const std::string& verdict : table.find("resolves_name")->texts) CHECK(verdict == "no");
  CHECK_THAT(read_file(options.out / "resolution.svg"), Catch::Contains("d50 13.4 mm"));

  const std::string csv = read_file(options.out / "resolution.csv");
  int files = 0;
  const auto long_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(24);
  for (const auto& entry : std::filesystem::directory_iterator(options.out / "cases")) {
    ++files;
    std::filesystem::last_write_time(entry, long_ago);
  }
  CHECK(files == 2);
  CHECK(printed(run_resolution_study, options) == first);
  CHECK(read_file(options.out / "resolution.csv") == csv);
  for (const auto& entry : std::filesystem::directory_iterator(options.out / "cases")) {
    CHECK(entry.last_write_time() < long_ago + std::chrono::hours(1));  // not run again
  }
}

TEST_CASE("half a strip at a mirror stands beside the whole one, in half the box") {
  const ScratchFolder scratch;
  StudyOptions options = coarse(scratch);
  options.bodies = {"mirror"};
  options.lengths_mm = {280};
  printed(run_resolution_study, options);
  const SampleTable table = read_samples(options.out / "resolution.csv");
  CHECK(table.find("body_name")->texts.front() == "smooth strip");
  CHECK(table.find("body_name")->texts.back() == "half at a mirror");
  CHECK(table.find("box_mm_name")->texts.front() == "280x150x100");
  CHECK(table.find("box_mm_name")->texts.back() == "140x150x100");
  // The same pressure within a factor of three: 1,000 grains 40 mm from a wall scatter as much.
  const auto& pressure_Pa = table.find("pressure_Pa")->numbers;
  REQUIRE(pressure_Pa.size() == 6);
  CHECK(pressure_Pa.back() < 3 * pressure_Pa[2]);
  CHECK(pressure_Pa.back() > pressure_Pa[2] / 3);
}

TEST_CASE("the time-step study compares every step with the shortest") {
  const ScratchFolder scratch;
  StudyOptions options = coarse(scratch);
  printed(run_time_step_study, options);
  const SampleTable table = read_samples(options.out / "time-step.csv");
  const auto& step = table.find("step_us")->numbers;
  const auto& share = table.find("over_rayleigh_ratio")->numbers;
  const auto& difference = table.find("rms_difference_ratio")->numbers;
  REQUIRE(step.size() == 12);
  CHECK(step.front() == Approx(2 * 3.6));
  // pi R sqrt(rho/G) / (0.1631 nu + 0.8766) is 20.86 us at R = 1 mm (the paper's 2.8 us is 13.4 %).
  CHECK(share[1] == Approx(0.134).epsilon(0.01));
  CHECK(difference.front() == 0);
  CHECK(difference[1] > 0);
  const auto& outcome = table.find("outcome_name")->texts;
  CHECK(outcome.front() == "done");
  for (std::size_t i = 0; i < step.size(); ++i) {
    CHECK(std::isnan(difference[i]) == (outcome[i] == "blew up"));
  }
}

TEST_CASE("the size of the search cells changes the time and the order of sums only") {
  const ScratchFolder scratch;
  StudyOptions options = coarse(scratch);
  printed(run_cell_size_study, options);
  const SampleTable table = read_samples(options.out / "cell-size.csv");
  const auto& cell = table.find("cell_mm")->numbers;
  REQUIRE(cell.size() == 6);
  CHECK(cell.front() == 0);
  CHECK(cell.back() == Approx(6 * 3.6));  // radius of 1 mm at the paper's scale
  // Sums in another order differ in their last bits, and a pressed bed makes more of it; within
  // 5 mm at this speed that stays under a hundredth.
  for (const double d : table.find("largest_difference_ratio")->numbers) CHECK(d < 0.01);
  for (const double t : table.find("time_s")->numbers) CHECK(t > 0);
}

TEST_CASE("grains too large for the box of a study are refused with the bound") {
  const ScratchFolder scratch;
  StudyOptions options = coarse(scratch);
  options.scales = {8};
  CHECK_THROWS_WITH(run_resolution_study(options),
                    Catch::Contains("must be at least 4 of the largest grains"));
}

TEST_CASE("flags of the studies are checked as they are parsed") {
  parse(
      "study resolution --full --beds 5 --seed 3 --scales 3.6,2.1 --lengths 160,240 "
      "--bodies strip,mirror,foot --threads 2 --out o --bed-folder b --set bed.depth_mm=50");
  parse("study box --bodies foot --beds 3");
  parse("study time-step --scales 1");
  parse("study cell-size --threads 1");
  for (const char* wrong :
       {"study", "study sand", "study resolution --beds 0", "study resolution --scales 0",
        "study resolution --scales x", "study resolution --bodies elephant",
        "study box --lengths 3", "study time-step --bodies strip", "study box --threads 0",
        "study box --seed -1"}) {
    CAPTURE(wrong);
    CLI::App app;
    Invocation invocation;
    add_study_command(app, invocation);
    CHECK_THROWS_AS(app.parse(wrong), CLI::ParseError);
  }
}
