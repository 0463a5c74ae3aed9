// Every fault in every mode, and that the table finds what is not as expected.

#include "tools/faults/matrix.h"

#include <catch2/catch.hpp>
#include <iostream>
#include <set>

#include "tools/faults/matrix_report.h"

using namespace hoof;
using firmware::control::Mode;
using tools::MatrixCell;
using tools::run_matrix;

TEST_CASE("every fault in every mode: reaction, time to the safe state, recovery") {
  tools::MatrixOptions options;
  options.jobs = 2;
  const std::vector<MatrixCell> cells = run_matrix(options, {});
  CHECK(cells.size() == 7 * tools::matrix_cases().size());
  std::set<std::string> gaps;
  for (const MatrixCell& cell : cells) {
    INFO(cell_line(cell));
    CHECK(cell.misses == "");
    if (!cell.gaps.empty()) gaps.insert(cell.fault);
  }
  // What is known not to be found; one that is mended has to lose its mark.
  CHECK(gaps == std::set<std::string>{"corrupt: commands of the knee"});
}

TEST_CASE("what is asked of a cell is asked: each broken expectation is a miss of its own") {
  const auto misses = [](const char* fault, Mode mode, const auto& change) {
    std::vector<tools::MatrixCase> cases;
    for (tools::MatrixCase& c : tools::matrix_cases()) {
      if (c.name == fault) cases.push_back(std::move(c));
    }
    REQUIRE(cases.size() == 1);
    change(cases[0]);
    const auto cells = run_matrix(cases, {{mode}, "", 1}, {});
    REQUIRE(cells.size() == 1);
    return cells[0].misses;
  };
  using Catch::Contains;
  const char* const jump = "encoder_jump: hip, 5 deg";
  CHECK(misses(jump, Mode::kReady, [](auto&) {}) == "");
  CHECK_THAT(misses(jump, Mode::kReady, [](auto& c) { c.moving.surge_s = 0; }),
             Contains("pushed too hard for "));
  CHECK_THAT(misses(jump, Mode::kReady, [](auto& c) { c.moving.safe_s = 0.001; }),
             Contains("safe after 3 ms, bound 1 ms"));
  CHECK_THAT(misses(jump, Mode::kReady,
                    [](auto& c) { c.moving.bits = firmware::control::fault::kBrownOut; }),
             Contains("no brown_out; unexpected: implausible_reply"));
  CHECK_THAT(misses(jump, Mode::kReady, [](auto& c) { c.moving = {}; }),
             Contains("not harmless: implausible_reply") && Contains("ended in mode fault"));
  CHECK_THAT(misses(jump, Mode::kReady, [](auto& c) { c.fault.amount = 0; }),
             Contains("the fault changed nothing") && Contains("no implausible_reply"));
  CHECK_THAT(misses("drop: heartbeat", Mode::kReady,
                    [](auto& c) { c.moving.bits = firmware::control::fault::kSyncLost; }),
             Contains("no sync_lost; drives still push; ended in mode ready"));
}

TEST_CASE("there is a case for every kind of fault") {
  std::set<bridge::FaultKind> kinds;
  for (const tools::MatrixCase& c : tools::matrix_cases()) kinds.insert(c.fault.kind);
  CHECK(kinds.size() == bridge::kFaultKindNames.size());
}

TEST_CASE("the table does not depend on the number of jobs") {
  tools::MatrixOptions options;
  options.modes = {Mode::kReady};
  options.only = "drop";
  const auto one = run_matrix(options, {});
  options.jobs = 3;
  const auto three = run_matrix(options, {});
  CHECK(tools::matrix_html(one) == tools::matrix_html(three));
  CHECK(one.size() > 3);
}

TEST_CASE("a cell that misses is a failure in JUnit, and its text cannot break the XML") {
  MatrixCell good, bad;
  good.fault = "a";
  bad.fault = "<b> & \"c\"";
  bad.misses = "drives still push";
  const std::string xml = tools::matrix_junit({good, bad});
  CHECK(xml.find("tests=\"2\" failures=\"1\"") != std::string::npos);
  CHECK(xml.find("<failure type=\"reaction\" message=\"drives still push\"/>") !=
        std::string::npos);
  CHECK(xml.find("<b>") == std::string::npos);
  CHECK(tools::matrix_markdown({good, bad}).find("**MISSED: drives still push**") !=
        std::string::npos);
}
