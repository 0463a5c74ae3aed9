// DIR/manifest.json: every run of a campaign as whoever makes it must know it, written before the
// first is made.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/reproduce/run_store.h"

namespace hoof::tools {

/// Those that are there already stay, so that jobs under way find theirs; equal names are replaced.
void write_manifest(const std::filesystem::path& campaign, const std::vector<PlannedRun>& runs);

/// @throws UserError where there is none, or one that does not read
std::vector<PlannedRun> read_manifest(const std::filesystem::path& campaign);

/// @throws UserError that says how many there are
PlannedRun find_run(const std::vector<PlannedRun>& runs, const std::string& id);

}  // namespace hoof::tools
