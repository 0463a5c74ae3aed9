// Every fault in every mode: what the firmware made of it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/faults/matrix_cases.h"

namespace hoof::tools {

/// One fault in one mode, on rigid ground, in process.
struct MatrixCell {
  std::string fault;  // name of the case
  std::string why;    // of the case
  firmware::control::Mode mode = firmware::control::Mode::kOff;
  std::uint32_t faults = 0;      // bits that came after the fault began
  double began_s = 0;            // simulated time
  std::optional<double> trip_s;  // from there to the first bit
  std::optional<double> safe_s;  // from there until no drive pushed any more, for good
  double surge_s = 0;            // for which a drive pushed more than it ever should
  std::uint64_t changed = 0;     // what the fault really did
  std::string end_mode;          // at the end of the fault and of the stop
  bool reset = false;            // the reset led to off, without a fault
  bool moves = false;            // and an order moves it again
  std::string gaps;              // what is known not to be as it should
  std::string misses;            // what was not as expected; empty: all was
};

struct MatrixOptions {
  std::vector<firmware::control::Mode> modes;  // empty: all
  std::string only;                            // part of a case's name; empty: all
  int jobs = 1;
};

/// @param cases in each of the modes
/// @param done called after each cell, in order; returns false to stop
/// @return all cells, by mode and case, or those done before the stop
/// @throws std::runtime_error where a mode cannot be reached without a fault
std::vector<MatrixCell> run_matrix(const std::vector<MatrixCase>& cases,
                                   const MatrixOptions& options,
                                   const std::function<bool(const MatrixCell&)>& done);

/// The same with all cases that there are.
std::vector<MatrixCell> run_matrix(const MatrixOptions& options,
                                   const std::function<bool(const MatrixCell&)>& done);

}  // namespace hoof::tools
