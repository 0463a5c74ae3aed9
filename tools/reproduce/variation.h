// What the paper leaves open, or does otherwise than we, varied one thing at a time.
#pragma once

#include <string>
#include <vector>

#include "tools/reproduce/cell.h"
#include "tools/reproduce/outcome.h"

namespace hoof::tools {

struct Variation {
  std::string name;  // of the runs' folders: "long-spines"
  std::string kind;  // what it is of: "geometry", "grain size", "calibration", "packing", "box" ...
  std::string what;  // in words, with the numbers and where they come from
  /// "dotted.key=value": of all runs, of those of a foot, of those of a kind.
  std::vector<std::string> of_all = {};
  std::vector<std::string> of_spined = {}, of_toed = {}, of_sole = {};
  std::vector<std::string> of_sinkage = {}, of_traction = {};

  /// Empty where it is the same run.
  std::vector<std::string> changes(const Cell& cell) const;
};

/// A point of the set of triples to which the paper's repose angle is one and the same.
struct ValleyPoint {
  double restitution, rolling_friction, static_friction;
};
/// Three far from each other; the paper's own is (0.54, 0.34, 0.52).
const std::vector<ValleyPoint>& valley_points();

/// Those that the paper's claims are judged over: geometry, grain size and calibration.
/// @param settings of the runs: grain size, time step and depth are changed from theirs
std::vector<Variation> claim_variations(const CampaignSettings& settings);
/// These, and what else may be why a number is not the paper's: packing, law, box, load, path.
std::vector<Variation> all_variations(const CampaignSettings& settings);

/// Of the same, for the command line: no settings need be read.
const std::vector<std::string>& claim_variation_names();
const std::vector<std::string>& variation_names();

/// The cell under a variation; the cell itself where that changes nothing of it.
Cell varied(const Cell& cell, const Variation& variation);
/// What holds under a variation too: the base's outcomes of conditions that it changes nothing of.
Outcomes unchanged(const Outcomes& base, const Variation& variation);

}  // namespace hoof::tools
