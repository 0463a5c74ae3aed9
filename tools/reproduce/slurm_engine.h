// The runs of a campaign as array jobs of a Slurm cluster.
//
// Slurm is believed in one thing only: what is in its queue. A run is done when its outputs are
// valid by their hashes; what is neither done nor in the queue nor held by a process is submitted
// again, whatever became of its job. Jobs are known by names of their own: a controller that lost
// its state gives old numbers to new jobs.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tools/reproduce/run_store.h"

namespace hoof::tools {

struct SlurmSettings {
  int at_once = 0;         // tasks of an array that may run at once; 0: as the cluster likes
  std::string time;        // limit of a task, as of sbatch --time; empty: the partition's
  int stop_ahead_s = 120;  // SIGUSR1 so long before it: time for a checkpoint
  int threads = 1;         // --cpus-per-task
  std::vector<std::string> options;  // more of sbatch, as they are
  bool wait = false;                 // until all is done, submitting what gets lost
  double poll_s = 10;                // between looks while waiting
};

struct SlurmState {
  std::size_t submitted = 0;  // by this call
  std::size_t queued = 0;     // in the queue, waiting or running, those included
  std::size_t outside = 0;    // being made by a process that the queue does not know (any more)
  std::vector<std::string> failed = {};  // by the account of their last try, with the reason
};

class SlurmEngine {
 public:
  explicit SlurmEngine(SlurmSettings settings) : settings_(std::move(settings)) {}

  /// One look: submits what is missing and under way nowhere. A run that failed is tried once in
  /// each call. `missing` is what is not done.
  SlurmState reconcile(const RunStore& store, const std::vector<PlannedRun>& missing);

  /// Looks again and again until nothing is under way. `look` gives what is still missing.
  /// @throws Interrupted after Ctrl-C: jobs go on
  SlurmState wait(const RunStore& store, const std::function<std::vector<PlannedRun>()>& look);

 private:
  SlurmSettings settings_;
  std::map<std::string, int> tries_;  // of each run, by this call
};

}  // namespace hoof::tools
