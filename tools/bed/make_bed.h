// hoof bed make: a bed with progress, kept for runs or written where it was asked for.
#pragma once

#include <filesystem>

#include "tools/bed/bed_source.h"

namespace hoof::tools {

struct MakeBedOptions {
  BedOptions bed;
  std::filesystem::path out;  ///< empty: where runs look for it
  bool force = false;         ///< make it again, in place of one that is there
  bool quiet = false;
  double checkpoint_every_min = 2;  ///< writing a million grains takes about a second
};

/// Makes the bed unless it is there, and prints its report; the file's path is the last line.
/// @throws sim::ConfigError, UserError, CannotFinish, Interrupted
void make_bed(const MakeBedOptions& options);

/// The same of a bed that a run needs, without a report. @param options its bed and out say nothing
void make_bed(const ChosenBed& chosen, const MakeBedOptions& options);

}  // namespace hoof::tools
