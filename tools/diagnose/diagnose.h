// From recordings to a verdict.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

struct DiagnoseOptions {
  /// Part of the contract's command. The search draws nothing: any seed gives the same verdict.
  std::uint64_t seed = 1;
  int threads = 2;
  /// Called from the thread that called diagnose(), with the share of the work that is done and
  /// what is being done. False: stop soon; what diagnose() then returns is worth nothing.
  std::function<bool(double share, const std::string& doing)> progress = {};
};

/// Same data sets and seed, same verdict, for any number of threads.
/// @param data_sets of one machine: they share setup and effects
Verdict diagnose(const std::vector<DataSet>& data_sets, const DiagnoseOptions& options);

}  // namespace hoof::tools
