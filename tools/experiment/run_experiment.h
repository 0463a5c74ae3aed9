// One sinkage or traction run from settings to a finished folder.
#pragma once

#include <filesystem>

#include "tools/experiment/run_settings.h"

namespace hoof::tools {

struct RunOutput {
  std::filesystem::path out;  // empty: runs/<experiment>-<date>-<n>
  bool force = false;
  bool live = false;
  bool quiet = false;
};

/// Runs, writes the folder and its report, prints the summary; the folder's path is the last line.
/// @throws UserError, sim::ConfigError, CannotFinish, Interrupted
void run_experiment(const RunSettings& run, const RunOutput& output);

}  // namespace hoof::tools
