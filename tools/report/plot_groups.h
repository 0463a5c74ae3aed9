#pragma once

#include <string>
#include <vector>

#include "tools/report/display_unit.h"
#include "tools/report/sample_table.h"

namespace hoof::tools {

/// Columns that share one plot, all of the same unit.
struct PlotGroup {
  std::string title;
  DisplayUnit unit;
  std::vector<const SampleColumn*> columns;
};

/// Sorts the numeric columns of `table`, but for time_s, into plots by one table of rules; what
/// no rule names is put together by its unit. Points into `table`.
std::vector<PlotGroup> group_plots(const SampleTable& table);

}  // namespace hoof::tools
