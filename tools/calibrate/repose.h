// hoof calibrate repose: heaps from a funnel, against the source paper's angle and its table 2.
#pragma once

#include <vector>

#include "tools/calibrate/findings.h"
#include "tools/calibrate/heap_runner.h"

namespace hoof::tools {

struct ReposeSettings {
  HeapTest test;  // its seed is that of the first heap; the next count on
  int seeds = 5;
  bool table2 = false;  // also every combination of table 2

  /// @throws std::invalid_argument naming the first broken rule, its value and bound
  void validate() const;
};

/// What is to be made: `seeds` heaps of the materials and, if asked for, of each combination of
/// table 2, the paper's own order, repeats once.
std::vector<HeapCase> repose_cases(const sim::Materials& materials, const ReposeSettings& settings);

/// @param results of repose_cases()
Findings find_repose(const sim::Materials& materials, const ReposeSettings& settings,
                     const std::vector<HeapCase>& cases, const std::vector<HeapResult>& results);

}  // namespace hoof::tools
