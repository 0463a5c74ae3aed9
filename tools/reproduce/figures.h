// The campaign's figures: the paper's numbers beside ours.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tools/reproduce/cell.h"
#include "tools/reproduce/outcome.h"

namespace hoof::tools {

struct Figure {
  std::string name;  // of its file, without ending
  std::string svg;
};

/// Of the parts asked for, those of which anything was run. Lines: mean over the beds, bars: one
/// standard deviation over the beds; dashed: the paper's numbers.
std::vector<Figure> draw_figures(const Outcomes& outcomes, const std::set<Part>& parts);

}  // namespace hoof::tools
