// The same case in both codes, and how far apart they end.
#pragma once

#include <filesystem>
#include <string>

#include "tests/sim/dem/liggghts/cases.h"
#include "tests/sim/dem/liggghts/liggghts.h"

namespace hoof::sim::test {

/// LIGGGHTS's records kept in the repository.
std::filesystem::path record_file(const std::string& name);

constexpr int kTraceSteps = 10;  // from one line of a trace to the next

/// Runs LIGGGHTS now: the traced grains every kTraceSteps, all at the end.
Dump liggghts_now(const FreeCase& c);

/// Our engine at the steps of `asked`, velocities taken to the step itself.
Dump our_engine(const FreeCase& c, Precision precision, const Dump& asked);
Dump our_engine(const FreeCase& c, const DemSettings& settings, const Dump& asked);

struct Apart {
  double speed = 0;       // largest difference of velocity or rim speed over the case's own speed
  double rms = 0;         // of the same ratio
  double position_m = 0;  // largest difference of position
  std::string where;      // grain and step of the largest difference of speed
};
/// @throws std::runtime_error where a grain of `theirs` is missing in `ours`
Apart compare(const FreeCase& c, const Dump& ours, const Dump& theirs);

/// Catch checks that both agree within the bounds stated there.
void check_agreement(const FreeCase& c, Precision precision, const Dump& ours, const Dump& theirs);

}  // namespace hoof::sim::test
