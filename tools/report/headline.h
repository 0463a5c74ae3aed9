#pragma once

#include <string>
#include <vector>

#include "tools/report/run_data.h"

namespace hoof::tools {

/// One line of the table at the top of a report.
struct HeadlineRow {
  std::string label;
  std::string value;
  std::string unit;
};

/// The few values that a reader looks for first: foot, load, depth, toes, traction. Values that
/// the run does not have are left out.
std::vector<HeadlineRow> headline(const RunData& data);

/// A value as a reader wants it, four significant digits, in the unit its key spells.
HeadlineRow headline_row(const std::string& label, const std::string& key,
                         const nlohmann::ordered_json& value);

}  // namespace hoof::tools
