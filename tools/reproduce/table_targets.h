// The targets of the paper's tables 2 to 5, as the laboratories of hoof calibrate left them in a
// campaign's folder.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/reproduce/comparison.h"

namespace hoof::tools {

/// Those with a band, table after table; one row that is not run for a table that is not there.
/// @throws UserError where a result does not read
std::vector<Comparison> table_targets(const std::filesystem::path& campaign);

}  // namespace hoof::tools
