// Random trajectory problems, by family. The same seed gives the same cases everywhere.
#pragma once

#include <cstdint>
#include <string>

#include "tools/trajectory/case_table.h"

namespace hoof::tools::trajectory {

// SplitMix64 (Steele, Lea and Flood, 2014), and distributions of our own: those of the standard
// library differ between implementations.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next();
  double uniform(double low, double high);
  double log_uniform(double low, double high);  // low, high > 0
  double normal(double sigma);
  int integer(int low, int high);  // both included
  bool chance(double probability) { return uniform(0, 1) < probability; }

 private:
  std::uint64_t state_;
};

// Those of the case files, with the distributions read off them, and `blocked`, which they have
// only by chance. (`invalid` and `zero_limits` have no solution in general: unit tests have those.)
enum class Family : std::uint8_t {
  kBase,
  kAsymmetric,
  kHoof,  // joints of a leg: fast and stiff
  kRestToRest,
  kTargetMoving,
  kTiny,
  kHuge,
  kLattice,
  kExactLimits,
  kZeroDisplacement,
  kBlocked,      // both ends push the same way, close together: gaps in the feasible durations
  kReplan,       // the start is a sample of a running profile
  kReplanFloat,  // the same, rounded to float
  kStartOutside,
  kNoJerkLimit,
  kVelocity,
  kPhase,
  kMinimumDuration,
  kDiscrete,
  kNoSync,
  kCount
};

const char* name(Family family);

// A valid input: every one has a solution. `joints` 0: one to four, as in the case files, and now
// and then five to eight.
Input random_input(Family family, Random& random, int joints = 0);

// As command-line text for `hoof trajectory solve`, one axis a line.
std::string as_command(const Input& input);

}  // namespace hoof::tools::trajectory
