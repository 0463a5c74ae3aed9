#pragma once

#include <filesystem>
#include <vector>

#include "tests/architecture/source_file.h"

namespace hoof::tests {

/// Files longer than 500 lines, headers without #pragma once, paths of one machine.
std::vector<Finding> check_files(const std::vector<SourceFile>& files);

/// Names below the root that the fixed top level does not have.
std::vector<Finding> check_top_level(const std::filesystem::path& root);

}  // namespace hoof::tests
