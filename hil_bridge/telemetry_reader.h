// Reads telemetry.lcm back into the plain rows it was written from.
#pragma once

#include <string>
#include <vector>

#include "hil_bridge/telemetry_log.h"

namespace hoof::bridge {

/// All samples of the log, in its order. Other channels are passed over; a last event that is cut
/// off ends the reading, as LCM's own readers do.
/// @throws std::runtime_error where the file cannot be opened, or a sample is of another type
std::vector<TelemetryRow> read_telemetry(const std::string& path);

}  // namespace hoof::bridge
