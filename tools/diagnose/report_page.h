// report.html of hoof diagnose, for a test engineer.
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// One file that opens offline: the answer, where, what, how much, what was assumed, how good the
/// data are, what next.
std::string report_page(const Verdict& verdict, const std::vector<DataSet>& data_sets);

}  // namespace hoof::tools
