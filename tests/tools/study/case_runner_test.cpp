#include "tools/study/case_runner.h"

#include <catch2/catch.hpp>
#include <csignal>

#include "sim/terrain/bed_file.h"
#include "tests/tools/run/scratch_folder.h"
#include "tests/tools/study/one_grain.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
using namespace hoof::tests;
using hoof::sim::BedStore;

namespace {

/// A folder whose store holds the bed of one grain, so that nothing has to settle.
struct Place {
  Place() {
    std::filesystem::create_directories(beds);
    const PressCase c = one_grain_case();
    for (const std::uint64_t seed : {1, 2}) {
      hoof::sim::write_bed_file(BedStore(beds).file(c.bed, materials(), seed),
                                BedStore::key(c.bed, materials(), seed), one_grain());
    }
  }
  CaseRunner runner() const {
    return CaseRunner(folder, beds, materials(), 1, ProgressStyle::kSilent);
  }

  ScratchFolder scratch;
  std::filesystem::path folder = scratch.path() / "study", beds = scratch.path() / "beds";
};

std::vector<PressCase> two_cases() {
  std::vector<PressCase> cases(2, one_grain_case());
  cases[1].seed = 2;
  return cases;
}

}  // namespace

TEST_CASE("a finished case is read, not run again") {
  const Place place;
  std::filesystem::path kept;
  {
    CaseRunner runner = place.runner();
    const auto curves = runner.run("study", two_cases());
    REQUIRE(curves.size() == 2);
    CHECK(curves[0].samples.back().force_N > 0);
    // The same grain at both seeds.
    CHECK(curves[0].samples.back().force_N == curves[1].samples.back().force_N);
    kept = runner.file(two_cases()[0]);
  }
  CHECK_THAT(kept.filename().string(),
             Catch::StartsWith("strip-plain_1x_100x60x4_seed_1-") && Catch::EndsWith(".csv"));
  PressCurve other;
  other.grain_count = 1;
  other.samples = {{1e-3, 42, 0, 0, 0, 0}};
  write_curve(kept, other);
  const auto again = place.runner().run("study", two_cases());
  CHECK(again[0].samples.back().force_N == 42);
  CHECK(again[1].samples.back().force_N != 42);

  std::filesystem::remove(kept);
  CHECK(place.runner().run("study", two_cases())[0].samples.back().force_N != 42);
}

TEST_CASE("Ctrl-C keeps what is finished and says where") {
  const Place place;
  CaseRunner runner = place.runner();
  runner.run("study", {two_cases()[0]});
  std::raise(SIGINT);
  try {
    runner.run("study", two_cases());
    FAIL("was not interrupted");
  } catch (const Interrupted& e) {
    CHECK(e.exit_status() == 130);
    CHECK_THAT(e.what(), Catch::Contains((place.folder / "cases").string()));
  }
  CHECK(std::filesystem::exists(runner.file(two_cases()[0])));
  CHECK_FALSE(std::filesystem::exists(runner.file(two_cases()[1])));
}

TEST_CASE("a folder that cannot be made is named") {
  const ScratchFolder scratch;
  write_file(scratch.path() / "file", "");
  CHECK_THROWS_WITH(
      CaseRunner(scratch.path() / "file", scratch.path(), materials(), 1, ProgressStyle::kSilent),
      Catch::Contains("file/cases: Not a directory"));
}
