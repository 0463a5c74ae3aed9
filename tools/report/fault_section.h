// What a run's faults did and what the firmware made of them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hoof::tools {

/// Two tables, faults and reaction; empty for a run without faults.
std::string fault_section(const nlohmann::ordered_json& result);

/// What the plots mark: [{"time_s":..., "name":...}], begin and end of each fault, the firmware's
/// first fault bit, and the time from which on no drive pushed.
std::string json_fault_marks(const nlohmann::ordered_json& result);

}  // namespace hoof::tools
