// hoof bed export: a kept bed, and a foot on it, for other programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/bed/bed_source.h"

namespace hoof::tools {

struct ExportBedOptions {
  BedOptions bed;
  std::filesystem::path csv;      ///< file, or empty
  std::filesystem::path vtk;      ///< folder, or empty
  std::vector<double> region_mm;  ///< x0, x1, y0, y1, z0, z1; empty: everywhere
  int every = 1;                  ///< grains whose id is a multiple
  std::string foot;               ///< preset or STL file to show above the sand; empty: none
  double foot_height_mm = 0;      ///< of its sole above the sand
  double toe_deg = 0;             ///< opening of each toe
};

/// Prints the paths of what was written. @throws UserError, sim::ConfigError
void export_bed(const ExportBedOptions& options);

}  // namespace hoof::tools
