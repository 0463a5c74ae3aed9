// Signals of a recording as a page with plots, or as a drawing.
#pragma once

#include <string>
#include <vector>

#include "tools/log/bus_recording.h"

namespace hoof::tools {

/// A self-contained page: one plot for each message and unit.
/// @throws UserError where no signal matches
std::string plot_page(const BusRecording& recording, const std::vector<std::string>& signals);

/// An SVG drawing of all of them over one axis; they must have one unit.
std::string plot_svg(const BusRecording& recording, const std::vector<std::string>& signals);

}  // namespace hoof::tools
