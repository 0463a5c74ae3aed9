// Runs of a campaign on this machine: one after another in this process, or some at once in
// processes of their own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/reproduce/run_store.h"

namespace hoof::tools {

struct LocalEngine {
  int jobs = 1;
  bool quiet = false;

  /// In order; `after` is told of each run once it is done. Of two runs that need a bed that is not
  /// there yet one makes it first. Runs that could not be finished are left out and returned, each
  /// with the reason.
  /// @throws Interrupted after Ctrl-C, with checkpoints; the same call goes on from there
  std::vector<std::string> run(const RunStore& store, const std::vector<PlannedRun>& missing,
                               const std::function<void(const std::string& id)>& after) const;
};

}  // namespace hoof::tools
