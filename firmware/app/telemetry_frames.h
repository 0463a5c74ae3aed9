// Which telemetry frame goes out in which tick.
#pragma once

#include <optional>

#include "firmware/app/telemetry.h"
#include "hal/can_frame.h"

namespace hoof::firmware::app {

/// One frame per tick at most, each in a slot of its own, so that a node with three mailboxes never
/// has to let its drive command wait.
/// @param leg whether the rig has one; without it nothing is said of it
[[gnu::noinline]] std::optional<hal::CanFrame> telemetry_frame(const Telemetry& telemetry, bool leg,
                                                               float hip_above_sand_m);

}  // namespace hoof::firmware::app
