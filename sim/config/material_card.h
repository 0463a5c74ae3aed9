// The card of a sand: what it is, where its numbers are from, for which law they were found, and
// what was measured of it in bulk. The [card] of a material file; for people and for
// `hoof material`, no part of a run.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/materials.h"

namespace hoof::sim {

struct Reference {
  std::string cite;  // as sources begin: "Ji et al. 2026"
  std::string author, year, title;
  std::string address;  // DOI or URL
};

/// In which a value may lie, in the unit of its key.
struct StatedRange {
  std::optional<double> low, high;
};
using StatedRanges = std::map<std::string, StatedRange>;  // by the value's key, "sand.young_MPa"

struct MaterialCard {
  std::string name;
  std::string about;   // the sand, in a line
  std::string status;  // "published" or "starting range"
  std::string law;     // for which contact law, rolling model and shape the coefficients were found
  std::optional<Measured> repose_rad;
  std::optional<Measured> bulk_density_kg_m3;
  std::optional<Measured> d50_m;
  std::vector<Reference> references;
  Materials materials;
  StatedRanges ranges;  // of those values that have one
};

/// A whole material file that has a [card].
/// @throws ConfigError naming file, line, key, value and bound; also where a source does not begin
/// with one of the card's references
MaterialCard read_material_card(const Settings& file);

/// What was measured of a sand in bulk, as a card has it.
/// @throws ConfigError
std::optional<Measured> read_repose(Reader& section);
std::optional<Measured> read_bulk_density(Reader& section);
std::optional<Measured> read_d50(Reader& section);
/// Of a whole file that was read, so that its ranges are known to hold their values.
StatedRanges stated_ranges(const Settings& file);
/// The tables [references.ID] below the section.
std::vector<Reference> read_references(const Reader& section);

/// @throws ConfigError where a key "....source" of the file does not begin with one of the cites
void require_sources(const Settings& file, const std::vector<Reference>& references);

/// Reads over the [card] of a run's materials.
void pass_over_card(Reader section);

}  // namespace hoof::sim
