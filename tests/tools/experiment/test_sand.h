// The bed on which the program itself is tested: settled once and kept (.cache/beds).
#pragma once

#include <string>
#include <vector>

namespace hoof::tests {

using Strings = std::vector<std::string>;

inline Strings joined(Strings a, const Strings& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Arguments of the program.
inline Strings on_test_sand(const Strings& more_settings) {
  // About 5,600 of the demo's coarse grains in the smallest box that foot and path fit in.
  const Strings bed = {"bed.box_length_mm=330", "bed.box_width_mm=260", "bed.depth_mm=93"};
  // Weaker sand than the paper's (0.52, 0.34): between grains half as wide as the sole, the paper's
  // carries a foot on a few chains of grains, and no test can tell one foot from the other.
  const Strings weak_sand = {"materials.sand_sand.static_friction=0.35",
                             "materials.sand_sand.rolling_friction=0.1"};
  Strings arguments;
  for (const std::string& setting : joined(joined(bed, weak_sand), more_settings)) {
    arguments.push_back("--set");
    arguments.push_back(setting);
  }
  return arguments;
}

}  // namespace hoof::tests
