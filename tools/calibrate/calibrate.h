// hoof calibrate: runs a laboratory, shows progress, prints its table, writes its folder.
#pragma once

#include <filesystem>

#include "tools/calibrate/findings.h"
#include "tools/calibrate/repose.h"
#include "tools/calibrate/single_grain.h"

namespace hoof::tools {

struct CalibrateOptions {
  std::filesystem::path material;  // empty: sim/config/materials/paper.toml
  CoefficientFlags flags;
  std::filesystem::path out;  // empty: runs/calibrate-<laboratory>
  bool quiet = false;
};

// Each prints its findings and the path of report.html.
// @throws UserError, sim::ConfigError, std::invalid_argument for what the user can mend;
// Interrupted after Ctrl-C (nothing of a single-grain laboratory is kept: it takes seconds)
void calibrate_restitution(const CalibrateOptions& options, const RestitutionSettings& settings);
void calibrate_rolling(const CalibrateOptions& options, const RollingSettings& settings);
void calibrate_sliding(const CalibrateOptions& options, const SlidingSettings& settings);

/// Finished heaps are kept in `out`/heaps and the one begun as well: after Ctrl-C the same command
/// goes on from there.
/// @param threads heaps at once
void calibrate_repose(const CalibrateOptions& options, const ReposeSettings& settings, int threads);

}  // namespace hoof::tools
