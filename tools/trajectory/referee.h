// Decides, by the slow search, whether a plan of the generator takes the shortest time.
#pragma once

#include "tools/trajectory/solve_case.h"

namespace hoof::tools::trajectory {

enum class Verdict {
  kOptimal,    // to 1e-6 of the duration + 1e-8 s
  kUndecided,  // something shorter exists if the end may be missed by 1e-12 (relative), not clearly
  kTooLong,
  kTooShort
};

// Of the latest plan of `generator`, which was for `input`. Brakes are taken from the plan: what
// they must do is a convention, not an optimum. An infinite jerk limit is judged as a very high
// one, to 1e-5.
Verdict judge(const Input& input, const GeneratorOf<double>& generator);

}  // namespace hoof::tools::trajectory
