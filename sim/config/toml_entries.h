// TOML text as flat entries with their origins. The only user of the TOML library for
// settings; data sets, which are lists of tables, are read by tools/diagnose.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/config/settings.h"

namespace hoof::sim {

/// Dotted keys and values in the order of the library's tables (alphabetical).
/// @param name stands for the file in origins and errors
/// @throws ConfigError for text that is not TOML, and for values no setting has (dates, mixed
/// arrays) or keys that are not bare (letters, digits, _ and -)
std::vector<std::pair<std::string, Entry>> toml_entries(std::string_view text,
                                                        const std::string& name);

}  // namespace hoof::sim
