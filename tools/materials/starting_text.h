// A starting range as a text to read.
#pragma once

#include <string>
#include <vector>

#include "tools/materials/material_shelf.h"
#include "tools/materials/starting_range.h"

namespace hoof::tools {

/// The grain density and what it stands on, with the solid share that quartz would have.
std::string density_text(const StartingRequest& request);

/// The set, its members, what a second test of each coefficient leaves, and what to beware of.
std::string range_text(const ReposeSurface& surface, const StartingRequest& request,
                       const StartingRange& range);

/// Sands of the shelf whose angle is within 3 degrees or whose bulk density is within a tenth.
std::string alike_text(const Shelf& shelf, const StartingRequest& request);

}  // namespace hoof::tools
