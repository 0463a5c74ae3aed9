// The runs of a campaign on disk: what is finished is known by the hashes of settings and result.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/settings.h"
#include "tools/run/folder_lock.h"

namespace hoof::tools {

/// SHA-256 of what decides a run's result: every setting but the number of threads and
/// what is kept of the fields.
std::string settings_hash(const sim::Settings& settings);
/// The same of a foot's shape and mass alone.
std::string geometry_hash(const sim::Settings& settings);

/// A run as whoever makes it must know it.
struct PlannedRun {
  std::string id;                     // names its folder
  std::string kind;                   // "sinkage" or "traction"
  std::vector<std::string> settings;  // "dotted.key=value"
  std::string settings_sha256;        // of all its settings, as resolved
};
/// @throws UserError, sim::ConfigError where the settings are no run
PlannedRun planned_run(const std::string& id, const std::string& kind,
                       std::vector<std::string> settings);

/// How the last try of a run went: for people and for the account of time, no part of a result.
struct Attempt {
  std::string state;  // "running", "done", "stopped" (asked to), "failed"
  std::string why;    // of a failure, one line
  std::string where;  // host, process and, under Slurm, job
  int tries = 0;
};

struct RunTime {
  double run_s = 0;  // wall-clock, without the bed
  int threads = 1;
};

/// DIR/cells/ID is a run's folder, DIR/cells/ID.json the hashes of its settings and result,
/// DIR/attempts/ID.json how the last try went.
class RunStore {
 public:
  /// Makes the folders. @throws UserError where that is impossible
  explicit RunStore(std::filesystem::path folder);

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path place(const std::string& id) const { return folder_ / "cells" / id; }
  std::filesystem::path seal(const std::string& id) const {
    return folder_ / "cells" / (id + ".json");
  }

  /// Whole and of these settings. One that is whole and of others is an error: UserError names it
  /// and the first key that differs.
  bool done(const PlannedRun& run) const;
  /// The same, but of a run with other settings it says no.
  bool has(const PlannedRun& run) const;

  /// Made or finished, and sealed. False: why_not says why.
  /// @throws Interrupted once a checkpoint is written
  bool make(const PlannedRun& run, bool quiet, std::string& why_not) const;
  /// Of a run whose maker was killed between its end and its seal.
  void seal_if_open(const PlannedRun& run) const;

  /// Held by the process that makes this run, on any machine that sees the folder.
  std::unique_ptr<FolderLock> lock(const std::string& name) const;

  /// 0 s where it is not known.
  RunTime run_time(const std::string& id) const;
  /// Version of the program that made it, as its seal says.
  std::string code(const std::string& id) const;

  std::optional<Attempt> attempt(const std::string& id) const;
  void note_attempt(const std::string& id, const Attempt& attempt) const;

 private:
  bool can_be_resumed(const PlannedRun& run) const;
  void write_seal(const PlannedRun& run) const;

  std::filesystem::path folder_;
};

}  // namespace hoof::tools
