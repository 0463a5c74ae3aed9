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
  for (const MatrixCell& cell : cells) {
    INFO(cell_line(cell));
    CHECK(cell.misses == "");
  }
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
  CHECK(xml.find("<failure message=\"drives still push\"/>") != std::string::npos);
  CHECK(xml.find("<b>") == std::string::npos);
  CHECK(tools::matrix_markdown({good, bad}).find("**MISSED: drives still push**") !=
        std::string::npos);
}
