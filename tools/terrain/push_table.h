// Pushes as a table: what was measured, whole enough to be fitted again without the sand.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/terrain/push_case.h"

namespace hoof::tools {

/// One row per sample, each with its plate. Through a temporary file: whole or not there.
void write_pushes(const std::filesystem::path& file, const std::vector<Push>& pushes);

/// Rows of one name, one after the other, are one push.
/// @throws UserError naming file, line, column, value and bound
std::vector<Push> read_pushes(const std::filesystem::path& file);

}  // namespace hoof::tools
