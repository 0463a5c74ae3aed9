// One run of a campaign, made by a process of its own: a child of `hoof reproduce --jobs`, or a
// task of a Slurm job.
#pragma once

#include <filesystem>
#include <string>

#include "tools/reproduce/run_store.h"

namespace hoof::tools {

struct WorkerOptions {
  std::filesystem::path campaign;
  std::string id;
  bool bed_only = false;  // makes the bed that the run needs and stops there
  bool quiet = false;
  int parent = 0;  // ends at once when this process ends; 0: works for nobody
};

/// Where a run's bed is kept, and whether it needs one.
struct BedPlace {
  std::filesystem::path file;  // empty: not on grains
  bool there = false;
};
BedPlace bed_place(const PlannedRun& run);

/// The bed first, with checkpoints of its own, made by one process at a time; then the run, unless
/// it is done. Notes in DIR/attempts how it went. A run that another process is making is left to
/// that one.
/// @throws UserError, CannotFinish; Interrupted after SIGINT, SIGTERM or SIGUSR1, with a checkpoint
void work(const WorkerOptions& options);

/// What make_once() says of a run that another process is making.
inline constexpr char kHeldByAnother[] = "another process is making it";

/// The same in this process, of a store that is open: why it is not done, or nothing.
std::string make_once(const RunStore& store, const PlannedRun& run, bool quiet);

}  // namespace hoof::tools
