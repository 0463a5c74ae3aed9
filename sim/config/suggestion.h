// "Did you mean": the known name nearest to a mistyped one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace hoof::sim {

/// Number of single-character insertions, deletions, replacements and swaps of neighbours that turn
/// one text into the other (optimal string alignment).
int edit_distance(std::string_view a, std::string_view b);

/// The candidate meant by `name`: one that differs only in its unit suffix (width_cm, width_mm), or
/// else the nearest within a third of the name's length. Empty where none is near.
std::string suggest(std::string_view name, std::span<const std::string> candidates);

}  // namespace hoof::sim
