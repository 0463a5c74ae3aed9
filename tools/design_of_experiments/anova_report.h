// hoof anova: a response surface of runs that were made, as a table to read and files to use.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/design_of_experiments/response_surface.h"
#include "tools/design_of_experiments/valley.h"

namespace hoof::tools {

struct AnovaOptions {
  std::filesystem::path data;
  std::vector<std::string> factors;  // columns
  std::string response;              // a column
  std::vector<std::string> ranges;   // NAME=LOW:HIGH where the bounds are not those of the data
  SurfaceModel model = SurfaceModel::kQuadratic;
  bool smallest = false;  // is the optimum
  bool has_target = false;
  double target = 0, tolerance = 0;
  std::vector<std::string> doubts;  // NAME=DOUBT of a second test; others 5 % of the range
  std::filesystem::path out;        // "": print only
};

/// Column names, rows with a hole left out.
/// @throws UserError naming file, line and column
Runs read_runs(const std::filesystem::path& file, const std::vector<std::string>& factors,
               const std::string& response);

/// The text of the table; files anova.json, predicted.csv and, with a target, valley.csv in `out`.
/// @throws UserError for bad data, unknown names, files that cannot be written
std::string run_anova(const AnovaOptions& options);

}  // namespace hoof::tools
