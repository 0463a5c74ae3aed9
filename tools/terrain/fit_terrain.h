// hoof terrain fit: pushes plates into grains, fits a fast soil, says how far off it is.
#pragma once

#include <filesystem>
#include <string>

#include "sim/terrain/rft_settings.h"
#include "tools/bed/bed_source.h"

namespace hoof::tools {

struct FitTerrainOptions {
  BedOptions bed;
  std::string law = "linear";  ///< or bekker
  std::string start = "demo";  ///< soil whose other numbers are kept: a preset or a file
  double speed_m_s = 0.3;      ///< of the pushes
  double scale = 1;            ///< of the plates
  std::filesystem::path from;  ///< pushes measured before; no sand is moved
  std::filesystem::path out = "runs/terrain-fit";
  bool quiet = false;
};

/// Leaves pushes.csv and soil.toml in the folder `out`, prints the errors, then both paths.
/// Finished pushes are kept in cases/: after Ctrl-C the same command goes on.
/// @throws UserError, sim::ConfigError, CannotFinish, Interrupted
void fit_terrain(const FitTerrainOptions& options);

/// A soil by the name of a preset or by its file. @throws sim::ConfigError
sim::RftTerrainSettings load_soil(const std::string& name_or_file);

struct ShowTerrainOptions {
  std::string soil = "demo";
  double length_m = 0.1, width_m = 0.06;
  double depth_m = 0.03;
};

/// Prints a flat plate's pressure and force over depth.
void show_terrain(const ShowTerrainOptions& options);

}  // namespace hoof::tools
