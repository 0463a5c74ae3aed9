// A folder of runs that survives whatever ends the program: what is finished is known by its hash.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tools/reproduce/cell.h"
#include "tools/reproduce/local_engine.h"
#include "tools/reproduce/outcome.h"
#include "tools/reproduce/run_store.h"
#include "tools/reproduce/slurm_engine.h"
#include "tools/run/folder_lock.h"

namespace hoof::tools {

/// Who makes the runs.
struct Engine {
  bool slurm = false;
  SlurmSettings cluster;
  std::optional<int> jobs;     // at once on this machine; nothing: as many as threads leave cores
  std::optional<int> threads;  // of each run's sand solver; nothing: what jobs leave
  bool quiet = false;

  /// With `cores` to be had: the cores over the threads of each run, at least 1.
  int jobs_at_once(int cores) const;
  int threads_each(int cores) const;
};

/// What a call left to do.
struct CampaignEnd {
  std::vector<std::string> failed;  // with the reason
  std::size_t queued = 0;           // with Slurm
};

/// The cells of a plan in a folder, locked while this lives.
class Campaign {
 public:
  /// @param others looked at where they are done with these settings, and not made
  /// @throws UserError where another process works in the folder
  Campaign(const std::filesystem::path& folder, std::vector<Cell> cells,
           const CampaignSettings& settings, const std::vector<Cell>& others = {});

  bool done(const Cell& cell) const { return store_.done(planned(cell)); }

  /// Makes what is missing. `after` is told of each cell that this call saw done.
  /// @throws Interrupted after Ctrl-C; the same call goes on from there
  CampaignEnd run(const Engine& engine, const std::function<void()>& after);

  /// Of the cells without a variation, or of one; what was read once is kept.
  Outcomes outcomes(const std::string& variation = "") const;
  /// By foot.
  std::vector<std::pair<std::string, std::string>> geometry_hashes() const;
  /// Versions of the programs that made the finished runs.
  std::vector<std::string> codes() const;

  const std::vector<Cell>& cells() const { return cells_; }
  const RunStore& store() const { return store_; }
  const std::filesystem::path& folder() const { return store_.folder(); }
  const PlannedRun& planned(const Cell& cell) const { return planned_.at(cell.id()); }

 private:
  std::vector<Cell> cells_;
  std::vector<Cell> others_;
  RunStore store_;
  FolderLock lock_;
  std::map<std::string, PlannedRun> planned_;
  mutable std::map<std::string, Outcome> read_;
};

}  // namespace hoof::tools
