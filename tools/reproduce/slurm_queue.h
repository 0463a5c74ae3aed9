// What Slurm's own commands tell and take: squeue, sbatch, scancel. They are called as a user would
// call them, so that a cluster's own wrappers and settings act.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hoof::tools {

struct QueuedTask {
  std::string job;    // "12_3"
  std::string name;   // of its job
  int index = 0;      // in its array
  std::string state;  // "PENDING", "RUNNING", ...
  std::string reason;
  /// Will never start by itself: waits for a job that is gone, or its launch failed and it is held
  /// (a controller that lost its state gave it the number of a job that still ran).
  bool stuck() const {
    return reason == "DependencyNeverSatisfied" || reason.find("launch failed") != reason.npos;
  }
};

/// Tasks in the queue of jobs with these names, finished ones left out.
/// @throws CannotFinish where squeue cannot be run or its controller does not answer: nothing is
/// known then, and nothing may be submitted again
std::vector<QueuedTask> queued_tasks(const std::vector<std::string>& names);

/// The parser of that, of `squeue --noheader --array --format="%i|%j|%T|%r"`.
std::vector<QueuedTask> parse_squeue(const std::string& text);

/// @return the job's number  @throws CannotFinish with what sbatch said
std::string submit(const std::filesystem::path& script, const std::vector<std::string>& options);

void cancel(const std::string& job);

}  // namespace hoof::tools
