// report.html of a campaign.
#pragma once

#include <string>
#include <vector>

#include "tools/reproduce/campaign.h"
#include "tools/reproduce/comparison.h"
#include "tools/reproduce/figures.h"
#include "tools/reproduce/reproduce.h"

namespace hoof::tools {

/// One self-contained file: what was run, how many targets came out inside, all of them at a glance
/// and in a table, figures with the paper's numbers beside ours, what changes make of each.
std::string summary_page(const Campaign& campaign, const ReproduceOptions& options,
                         const std::vector<Comparison>& rows, const std::vector<Figure>& figures);

}  // namespace hoof::tools
