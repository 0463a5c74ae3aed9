// One sinkage or traction run from settings to a finished folder.
#pragma once

#include <filesystem>

#include "sim/terrain/journaled_terrain.h"
#include "tools/experiment/run_bus.h"
#include "tools/experiment/run_settings.h"

namespace hoof::tools {

struct RunOutput {
  std::filesystem::path out;  // empty: runs/<experiment>-<date>-<n>
  bool force = false;
  bool live = false;
  bool quiet = false;
  /// Between checkpoints of the grains, by the clock; 0: the run cannot be resumed.
  double checkpoint_every_s = sim::JournalSettings().checkpoint_every_s;
  BusChoice bus;  // of a run with its firmware on a CAN interface
  /// The run's effects stand here and nowhere in its folder; empty: nothing is concealed.
  std::filesystem::path truth = {};
  bool silent = false;  // prints no summary and no path
};

/// Runs, writes the folder and its report, prints the summary; the folder's path is the last line.
/// @throws UserError, sim::ConfigError, CannotFinish, Interrupted
void run_experiment(RunSettings run, const RunOutput& output);

/// Finishes a run that was cut off: its folder ends with the bytes of an undisturbed run.
/// @param kind "sinkage" or "traction"  @param folder "<run>.resume", or "<run>"
/// @throws as run_experiment
void resume_experiment(const std::string& kind, const std::filesystem::path& folder,
                       RunOutput output);

}  // namespace hoof::tools
