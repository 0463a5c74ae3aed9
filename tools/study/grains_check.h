// Are the soil's effects, as fast soil has them, what grains do where the cause is there?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/study/statistics.h"
#include "tools/study/study.h"

namespace hoof::tools {

/// Effects that are checked, by the name of the case, and those that grains cannot have.
struct GrainsCase {
  std::string name;
  std::string effect;  // the catalogue's
  std::string cause;   // in the grains; why not, where they cannot have it
  bool possible = true;
};
const std::vector<GrainsCase>& grains_cases();

/// Force with the cause over that without, less 1, in grains and on fast soil.
struct GrainsChange {
  Sample grains;  // over beds
  double fast = 0;
  bool fitted = false;  // fast soil's was set to agree here

  /// "yes", "no", "no effect on fast soil", or "not told": grains' change is within its 95 %
  /// interval about none.
  std::string sign_agrees() const;
  /// Change on fast soil over that in grains; not a number where grains do not tell.
  double size_ratio() const;

 private:
  bool told() const;
};

/// The same short press with and without each cause, in grains and on fast soil: a table, a plot.
/// Names of cases in options.bodies; empty: all. @throws UserError for one that there is not
void run_grains_check(const StudyOptions& options);

}  // namespace hoof::tools
