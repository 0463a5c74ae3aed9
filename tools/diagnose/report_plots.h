// The plots of report.html: what was measured, what the model says, and the difference.
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

struct ReportPlots {
  std::string html;  // two boxes a trace
  std::string json;  // what page.js draws into them
};

/// Recordings that the verdict points at first; where those are some, the others are folded away.
ReportPlots report_plots(const Verdict& verdict, RigKind rig);

/// Indices of at most about `most` samples that keep the peaks of all `series`.
std::vector<std::size_t> thinned(const std::vector<const std::vector<double>*>& series,
                                 std::size_t most);

}  // namespace hoof::tools
