// What the paper leaves open, varied one thing at a time: geometry, grain size, calibration.
#pragma once

#include <string>
#include <vector>

#include "tools/reproduce/cell.h"

namespace hoof::tools {

struct Variation {
  std::string name;  // of the runs' folders: "long-spines"
  std::string kind;  // "geometry", "grain size", "calibration"
  std::string what;  // in words, with the numbers and where they come from
  std::vector<std::string> of_spined, of_toed, of_sole, of_all;  // "dotted.key=value"

  /// Of one foot; empty where it is the same foot in the same sand.
  std::vector<std::string> changes(const std::string& foot) const;
};

/// A point of the set of triples to which the paper's repose angle is one and the same.
struct ValleyPoint {
  double restitution, rolling_friction, static_friction;
};
/// Three far from each other; the paper's own is (0.54, 0.34, 0.52).
const std::vector<ValleyPoint>& valley_points();

/// @param settings of every run: grain size and time step are changed from theirs
std::vector<Variation> claim_variations(const std::vector<std::string>& settings);

/// Of the same, for the command line: no settings need be read.
const std::vector<std::string>& variation_names();

/// The cell under a variation; the cell itself where that changes nothing of it.
Cell varied(const Cell& cell, const Variation& variation);

}  // namespace hoof::tools
