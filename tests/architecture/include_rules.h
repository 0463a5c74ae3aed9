#pragma once

#include <vector>

#include "tests/architecture/source_file.h"

namespace hoof::tests {

/// Include lines that break "who may include whom": our own headers by the table of rooms,
/// system headers by the table of what a room must do without.
std::vector<Finding> check_includes(const std::vector<SourceFile>& files);

}  // namespace hoof::tests
