// Reader of trajectory case files (tests/data/trajectory/README.md describes the columns).
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "firmware/trajectory/input.h"

namespace hoof::tools::trajectory {

inline constexpr int kMaxJoints = 8;
using Input = firmware::trajectory::Input<double, kMaxJoints>;

struct BlockedInterval {
  double left_s;
  double right_s;
};

struct Case {
  int id = 0;
  std::string family;
  Input input;
  int result = 0;                    // of the reference generator
  double duration_s = 0;             // NaN where the cell is empty, here and below
  std::vector<double> minimum_s;     // per axis, by the reference
  std::vector<double> axis_check_s;  // per axis, by the independent method
  double group_check_s = 0;          // of the group, by the independent method
  enum class Agreement { kUnchecked, kDiffer, kAgree } agreement = Agreement::kUnchecked;
};

// Throws std::runtime_error with the line number when a row cannot be read.
std::vector<Case> read_cases(std::istream& in);

}  // namespace hoof::tools::trajectory
