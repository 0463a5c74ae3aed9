// A part of a recording.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/log/bus_recording.h"

namespace hoof::tools {

struct CutRange {
  std::optional<double> from_s, to_s;               // since the recording's time 0
  std::optional<std::uint32_t> from_tick, to_tick;  // SYNC numbers, both included
};

/// From `from` to before `to` in time; by ticks from the SYNC on bus 0 of the first to before that
/// of the tick behind the last. @throws UserError where the recording has no such part
BusRecording cut(const BusRecording& recording, const CutRange& range);

}  // namespace hoof::tools
