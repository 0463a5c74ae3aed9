// Compares the generator with a file of solved cases, family by family, in double and in float.
#pragma once

#include <iosfwd>
#include <string>

namespace hoof::tools::trajectory {

// 0: every bar is kept; 1: one is missed; 2: the file cannot be read (said on `out`).
// Bars: double: |dT| <= 1e-6 T + 1e-8 s on every row both methods of the file confirm, on the
// independent method's value where they differ; no failure on an input that has a solution; T = 0
// where the start equals the target; no limit exceeded by more than 1e-9. Float: 1e-3 T + 1e-6 s,
// and 1e-4 on limits (both relative where the limit is above 1).
int run_trajectory_check(const std::string& path, std::ostream& out);

}  // namespace hoof::tools::trajectory
