#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/conceal/hidden_effect.h"
#include "tools/conceal/intervals.h"

namespace hoof::tools::conceal {

/// One case as truth.json has it.
struct TruthCase {
  std::string name, rig, kind;
  std::vector<HiddenEffect> effects;
  std::vector<std::string> alike;
  double effort_snr_db = 0.0;
  bool masked = false, foreseeable = true;
  /// Root mean square change that the parameters cannot explain, over the noise, by channel.
  std::map<std::string, double> channels;
  std::vector<std::string> fit_recordings;
  std::vector<TimeInterval> intervals;  ///< in the recordings that are there to be fitted
  std::map<std::string, double> holdout_rmse;

  bool nothing_hidden() const { return kind.starts_with("none"); }
  /// Channels that may be named as the one which shows it: the clearest, and any that is within a
  /// fifth of it.
  std::vector<std::string> clear_channels() const;
  std::string main_channel() const;
};

/// Reads the truth of a batch and checks it against truth.sha256; UserError where it was changed.
std::vector<TruthCase> read_truth(const std::filesystem::path& file,
                                  const std::filesystem::path& sealed_hash);

}  // namespace hoof::tools::conceal
