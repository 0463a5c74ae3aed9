// The sands that this project has numbers of: cards (sim/config/materials), which a run can use,
// and sands of which no more than a measurement in bulk is public (measured_sands.toml).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/config/material_card.h"

namespace hoof::tools {

struct Shelf {
  std::vector<sim::MaterialCard> cards;  // in alphabetical order of their files

  struct MeasuredSand {
    std::string id, about;
    std::optional<sim::Measured> repose_rad, bulk_density_kg_m3, d50_m;
  };
  std::vector<MeasuredSand> measured;
  std::vector<sim::Reference> measured_references;
  sim::StatedRanges measured_ranges;
};

/// The folder of sands measured in bulk and of the stored heaps.
std::filesystem::path default_materials_dir();

/// @throws sim::ConfigError naming file, line, key and value
Shelf read_shelf(const std::filesystem::path& config_dir = sim::default_config_dir(),
                 const std::filesystem::path& materials_dir = default_materials_dir());

/// A table: name, coefficients, angle and density where told, what it is.
std::string shelf_text(const Shelf& shelf);

/// A card with every value's range and source, its law and references.
/// @param name_or_file a card's name or a material file
/// @throws sim::ConfigError, UserError naming the cards that there are
std::string card_text(const Shelf& shelf, const std::string& name_or_file);

}  // namespace hoof::tools
