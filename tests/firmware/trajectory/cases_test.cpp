// Solved cases from file, and random ones against properties. `hoof trajectory check` and
// `hoof trajectory random` run the same.
#include <catch2/catch.hpp>
#include <iostream>
#include <sstream>

#include "tools/trajectory/check.h"
#include "tools/trajectory/random_check.h"

namespace hoof::tools::trajectory {
namespace {

TEST_CASE("the public cases keep every bar") {
  std::ostringstream report;
  const int status =
      run_trajectory_check(HOOF_TEST_DATA_DIR "/trajectory/cases_public.csv", report);
  INFO(report.str());
  CHECK(status == 0);
}

TEST_CASE("a file with a wrong duration misses the bar") {
  std::ostringstream report;
  CHECK(run_trajectory_check(HOOF_TEST_DATA_DIR "/trajectory/wrong_duration.csv", report) == 1);
  CHECK(report.str().find("A BAR IS MISSED") != std::string::npos);
}

TEST_CASE("a file that is no table of cases is refused") {
  std::ostringstream report;
  CHECK(run_trajectory_check(HOOF_TEST_DATA_DIR "/trajectory/README.md", report) == 2);
}

TEST_CASE("100,000 random cases") {
  std::ostringstream report;
  // Every 200th of each of the 20 families is judged by the slow search.
  const RandomCheckOptions options{100'000, 20240607, 200};
  const int status = run_trajectory_random(options, report);
  std::cout << report.str();
  INFO(report.str());
  CHECK(status == 0);
}

}  // namespace
}  // namespace hoof::tools::trajectory
