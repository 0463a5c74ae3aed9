// LIGGGHTS itself, run now, against its records and against our engine. Where it is not installed
// CTest lists these tests as skipped.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/sim/dem/liggghts/reference.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

bool liggghts_is_missing() {
  if (liggghts_is_installed()) return false;
  WARN("SKIPPED: liggghts is not installed; our engine was compared with its records only");
  return true;
}

void check_live(const FreeCase& c) {
  if (liggghts_is_missing()) return;
  const Dump now = liggghts_now(c);
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    check_agreement(c, precision, our_engine(c, precision, now), now);
  }
  // Records have ten digits.
  CHECK(compare(c, read_record(record_file(c.name)), now).speed < 1e-8);
}

}  // namespace

TEST_CASE("LIGGGHTS, run now: oblique pairs") {
  check_live(oblique_pairs());
}
TEST_CASE("LIGGGHTS, run now: oblique impacts on a plane") {
  check_live(oblique_impacts_on_plane());
}
TEST_CASE("LIGGGHTS, run now: oblique impacts on a mesh") {
  check_live(oblique_impacts_on_mesh());
}
TEST_CASE("LIGGGHTS, run now: impacts on edges and corners") {
  check_live(impacts_on_edges());
}

// Not a test: writes the records. HOOF_RECORD_FOLDER=... hoof_test_liggghts_live "[.record]"
TEST_CASE("write the records", "[.record]") {
  const char* folder = std::getenv("HOOF_RECORD_FOLDER");
  REQUIRE(folder != nullptr);
  for (const FreeCase& c : {oblique_pairs(), oblique_impacts_on_plane(), oblique_impacts_on_mesh(),
                            impacts_on_edges()}) {
    write_record(std::filesystem::path(folder) / (c.name + ".csv"), liggghts_now(c));
  }
}
