// The whole plate run, LIGGGHTS and our engine in both precisions: minutes, label full.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/sim/dem/liggghts/liggghts.h"
#include "tests/sim/dem/liggghts/plate_case.h"
#include "tests/sim/dem/liggghts/reference.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

TEST_CASE("a plate 6.7 mm deep in a bed presses as in LIGGGHTS's record") {
  const PlateForces theirs = read_forces(record_file("plate"));
  REQUIRE(theirs.size() == std::size_t(kPlateBlocks));
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    check_whole_plate(press_ours(precision, kPlateBlocks), theirs);
  }
}

TEST_CASE("LIGGGHTS, run now: a plate 6.7 mm deep in a bed") {
  if (!liggghts_is_installed()) {
    WARN("SKIPPED: liggghts is not installed");
    return;
  }
  const PlateForces now = press_liggghts(kPlateBlocks);
  const PlateForces record = read_forces(record_file("plate"));
  // The same program on the same machine repeats every digit; another processor's library may
  // round otherwise, and then only the bounds between two codes hold.
  CHECK(rms_difference(now, record, 0, 10) < 3e-6);
  check_whole_plate(now, record);
}

// Not a test: writes the record. HOOF_RECORD_FOLDER=... hoof_test_liggghts_plate "[.record]"
TEST_CASE("write the plate's record", "[.record]") {
  const char* folder = std::getenv("HOOF_RECORD_FOLDER");
  REQUIRE(folder != nullptr);
  write_forces(std::filesystem::path(folder) / "plate.csv", press_liggghts(kPlateBlocks));
}
