// All targets at a glance: what the runs gave over the paper's number, beside what is accepted.
#pragma once

#include <string>
#include <vector>

#include "tools/reproduce/comparison.h"

namespace hoof::tools {

/// SVG; a line for each target that the paper has a number above nothing of and that was run, in
/// the order of the rows. Logarithmic, a tenth to ten times the paper's number; what lies beyond
/// stands at the edge as a triangle. Filled: predictions and what has no band; hollow: inputs.
/// Empty where there is no such target.
std::string draw_targets(const std::vector<Comparison>& rows);

}  // namespace hoof::tools
