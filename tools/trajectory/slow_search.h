// The durations an axis can take, and the first one a group can take, found by scanning with the
// slow check: the judge of optimality. Shares nothing with firmware/trajectory but the numbers.
#pragma once

#include <optional>
#include <vector>

#include "tools/trajectory/slow_check.h"

namespace hoof::tools::trajectory {

struct Durations {
  double from_s;
  double to_s;  // equal to from_s where a single duration is feasible
};

struct SlowSearch {
  bool velocity_only = false;  // velocity interface: the position does not matter
  // Of the end state, relative to the size of the velocities and of the way: above 0 also what the
  // last digits may decide, below 0 only what is clear of them.
  double slack = 1e-12;
  int samples = 96;
};

// All feasible durations up to `end_s`, in order; their borders to 1e-9 of end_s or better.
// A feasible interval narrower than about a hundredth of its duration is found where the position
// margin has a local maximum there, or at the first or last duration the velocities allow.
std::vector<Durations> slow_durations(const AxisProblem& axis, double end_s,
                                      const SlowSearch& search);

// The first duration >= from_s that is in every axis's set (and a multiple of step_s where that is
// above 0), or none.
std::optional<double> first_common(const std::vector<std::vector<Durations>>& axes, double from_s,
                                   double step_s);

}  // namespace hoof::tools::trajectory
