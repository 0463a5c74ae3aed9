// How long the missing runs of a campaign will take, and how much disk: from those that are done.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/reproduce/run_store.h"

namespace hoof::tools {

struct Cost {
  double core_s = 0;      // of one run: wall-clock seconds times threads
  double disk_bytes = 0;  // of its folder
};

/// Costs of runs by what they are: of the same condition where one is done, else of the same kind
/// and speed, else of the same kind, else by a table of measured speeds (cost.cpp).
class CostModel {
 public:
  /// @param all every run of the campaign, done or not
  CostModel(const RunStore& store, const std::vector<PlannedRun>& all);

  Cost of(const PlannedRun& run) const;
  /// "12 finished runs of this folder", or where the figures come from otherwise.
  std::string source() const;

 private:
  struct Mean {
    double core_s = 0, disk_bytes = 0;
    int n = 0;
    void add(const Cost& cost);
    Cost cost() const { return {core_s / n, disk_bytes / n}; }
  };

  std::map<std::string, Mean> means_;
  int known_ = 0;
};

/// The line of a plan: hours of the missing runs with `jobs` at once, disk.
std::string cost_text(const CostModel& model, const std::vector<PlannedRun>& missing, int jobs,
                      int threads);

}  // namespace hoof::tools
