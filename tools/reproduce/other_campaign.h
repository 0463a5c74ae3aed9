// What another campaign's changes tell of this one's targets.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/reproduce/comparison.h"

namespace hoof::tools {

/// Fills `elsewhere` of each row that is outside and that the other campaign says something of:
/// that it is inside there, or what takes it inside there, with the name of its bed. Changes are
/// cheap in coarser grains and tell of finer ones as far as the two agree.
/// @param folder of that campaign, with summary.json
/// @throws UserError where there is none or it is of no grains
void ask_other_campaign(std::vector<Comparison>& rows, const std::filesystem::path& folder);

}  // namespace hoof::tools
