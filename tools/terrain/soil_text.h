// A fitted soil as the settings file that --soil reads, and the errors of a fit as a table.
#pragma once

#include <string>

#include "tools/terrain/soil_fit.h"

namespace hoof::tools {

/// TOML of a soil; reading it gives the same numbers. Holds no date: same pushes, same bytes.
/// @param command that made it, for the reader
std::string soil_toml(const sim::RftTerrainSettings& soil, const std::string& command);

std::string fit_table(const SoilFit& fit);

}  // namespace hoof::tools
