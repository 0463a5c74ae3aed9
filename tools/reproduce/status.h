// hoof campaign status: how far a campaign is, whoever makes its runs.
#pragma once

#include <filesystem>
#include <string>

namespace hoof::tools {

/// Counts of done, under way, failed and missing runs, those under way and failed by name, time
/// left. Changes nothing and needs no lock.
/// @throws UserError where the folder is no campaign
std::string campaign_status(const std::filesystem::path& folder);

}  // namespace hoof::tools
