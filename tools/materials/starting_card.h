// A starting range as a material file that a run takes.
#pragma once

#include <string>

#include "tools/materials/starting_range.h"

namespace hoof::tools {

/// The middle member as values, the whole set as their ranges; plastic and stiffness are the
/// paper's. @param name of the card  @param command that made it, as its source
/// @throws UserError where nothing gives the angle
std::string starting_card(const std::string& name, const std::string& command,
                          const ReposeSurface& surface, const StartingRequest& request,
                          const StartingRange& range);

}  // namespace hoof::tools
