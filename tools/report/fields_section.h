// What happened in the sand under the foot: numbers by moment, maps, the view in three dimensions.
#pragma once

#include <string>

#include "tools/report/run_data.h"

namespace hoof::tools {

/// Empty for a run that kept no fields.
std::string fields_section(const RunData& data);

}  // namespace hoof::tools
