// The campaign's figures: the paper's numbers beside ours.
#pragma once

#include <string>
#include <vector>

#include "tools/reproduce/outcome.h"

namespace hoof::tools {

struct Figure {
  std::string name;  // of its file, without ending
  std::string svg;
};

/// Those of which anything was run. Lines: mean over the beds, bars: one standard deviation over
/// the beds; dashed: the paper's numbers.
std::vector<Figure> draw_figures(const Outcomes& outcomes);

}  // namespace hoof::tools
