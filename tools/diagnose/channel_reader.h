// The channels of a rig out of the columns of a CSV file.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/rig_keys.h"
#include "tools/diagnose/toml_view.h"

namespace hoof::tools {

/// channel = scale * column + offset.
struct ChannelSource {
  std::string column;
  double scale = 1;
  double offset = 0;
  TomlView stated_in;  // for messages
};

using ChannelSources = std::map<std::string, ChannelSource>;

/// `base` with the channels of `table` over it.
ChannelSources read_channel_sources(const TomlView& table, const RigKeys& rig,
                                    const ChannelSources& base);

struct TimeWindow {
  double from_s = 0, to_s = 0;
};

/// Fills time and channels of `recording` from the file at its path.
/// @throws UserError with file and line, for time that does not run forward, too
void read_channels(const ChannelSources& sources, std::optional<TimeWindow> window,
                   const TomlView& stated_in, Recording& recording);

}  // namespace hoof::tools
