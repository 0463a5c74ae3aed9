// Angle of repose over (e, mu_r, mu_s): quadratics fitted to heaps of this engine and to the source
// paper's table 2, on the same box.
#pragma once

#include <filesystem>
#include <string>

#include "tools/design_of_experiments/response_surface.h"

namespace hoof::tools {

struct ReposeSurface {
  std::string name;         // "heaps of this engine"
  std::string made_of;      // in a sentence
  ResponseSurface surface;  // factors e, mu_r, mu_s; degrees
  double lowest_deg = 0;    // of the runs that it was fitted to
  double highest_deg = 0;
};

/// Fitted to every heap of design.csv of `hoof calibrate repose --full`, those of which a copy is
/// stored in repose_heaps.csv. @throws UserError
ReposeSurface surface_of_heaps(const std::filesystem::path& design_csv);

/// Fitted to the 17 runs of table 2.
ReposeSurface surface_of_paper();

}  // namespace hoof::tools
