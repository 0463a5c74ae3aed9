// The plots of report.html: what was measured, what the model says, and the difference.
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

struct ReportPlots {
  std::string html;          // two boxes a trace
  std::string planned_html;  // two boxes a channel of the experiment that is planned; may be empty
  std::string json;          // what page.js draws into them, in this order
};

/// The traces that are shown at once, by index, most telling first: of recordings that the verdict
/// points at, where what was found explains most; some of what was fitted and some held out.
std::vector<std::size_t> traces_to_open(const Verdict& verdict);

/// Those of traces_to_open first, the others folded away.
ReportPlots report_plots(const Verdict& verdict, RigKind rig);

/// Indices of at most about `most` samples that keep the peaks of all `series`.
std::vector<std::size_t> thinned(const std::vector<const std::vector<double>*>& series,
                                 std::size_t most);

}  // namespace hoof::tools
