// Random trajectory problems against properties no table is needed for.
#pragma once

#include <cstdint>
#include <iosfwd>

namespace hoof::tools::trajectory {

struct RandomCheckOptions {
  long count = 1'000'000;
  std::uint64_t seed = 1;
  // Every n-th case of a family is judged by the slow search (some 30 ms each): no shorter duration
  // of the group, and the one found feasible; and compared with its mirrored, reversed and rescaled
  // twins.
  int slow_every = 1000;
};

// Per case: a plan without failure; limits kept to 1e-9 (double) and 1e-4 (float), and states that
// join to 1e-6 and 2e-3 of their size, beyond what rounding explains (audit.h). Prints the seed, a
// line per family, and each broken case so that it can be pasted back. 0 when nothing is broken,
// else 1.
int run_trajectory_random(const RandomCheckOptions& options, std::ostream& out);

}  // namespace hoof::tools::trajectory
