// Why a target is missed: what becomes of it with one thing of the runs changed, or read otherwise.
#pragma once

#include <string>
#include <vector>

#include "tools/reproduce/comparison.h"
#include "tools/reproduce/outcome.h"

namespace hoof::tools {

/// The same conditions with one thing changed.
struct Altered {
  std::string kind;   // "geometry", "reading" ...
  std::string name;   // "long-spines"
  std::string what;   // in words
  Outcomes with;      // changed where the change is of a condition, else the base's
  Outcomes without;   // the base, of the beds that have a changed run
  bool both = false;  // read by the sole beside
};

/// @param changed what was run with the change, of the conditions that it is of
/// @param same the base of those that it is not of
Altered altered(std::string kind, std::string name, std::string what, const Outcomes& base,
                const Outcomes& changed, const Outcomes& same);

inline constexpr const char* kSoleReading = "sole-depth";
/// Depth as of read_by_sole(): no run is needed.
Altered sole_reading(const Outcomes& base);

/// The change with depth as of read_by_sole(), against the base read as ever.
Altered with_sole_reading(const Altered& change);

/// Fills `tried` of each row that has runs.
void try_changes(std::vector<Comparison>& rows, const std::vector<Altered>& changes);

}  // namespace hoof::tools
