// The table of the fault matrix, for people and for CI.
#pragma once

#include <string>
#include <vector>

#include "tools/faults/matrix.h"

namespace hoof::tools {

/// One line: mode, fault, bits, times, recovery, verdict.
std::string cell_line(const MatrixCell& cell);
/// One test case for each cell, one suite for each mode (the format that CI servers read).
std::string matrix_junit(const std::vector<MatrixCell>& cells);
/// Faults down, modes across; a page of its own, without network.
std::string matrix_html(const std::vector<MatrixCell>& cells);
std::string matrix_markdown(const std::vector<MatrixCell>& cells);

}  // namespace hoof::tools
