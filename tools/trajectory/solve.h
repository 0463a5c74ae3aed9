// One trajectory on paper: a table of its pieces, a plot in the terminal, an SVG.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>

#include "tools/trajectory/case_table.h"

namespace hoof::tools::trajectory {

struct SolveRequest {
  Input input;
  std::optional<std::filesystem::path> svg;
};

// 0; 1 when the input is refused or has no solution (said on `out`).
int run_trajectory_solve(const SolveRequest& request, std::ostream& out);

}  // namespace hoof::tools::trajectory
