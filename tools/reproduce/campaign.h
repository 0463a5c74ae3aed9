// A folder of runs that survives whatever ends the program: what is finished is known by its hash.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/config/settings.h"
#include "tools/reproduce/cell.h"
#include "tools/reproduce/comparison.h"
#include "tools/run/folder_lock.h"

namespace hoof::tools {

/// SHA-256 of what decides a run's result: every setting but the number of threads.
std::string settings_hash(const sim::Settings& settings);
/// The same of a foot's shape and mass alone.
std::string geometry_hash(const sim::Settings& settings);

/// DIR/cells/ID is a run's folder, DIR/cells/ID.json the hashes of its settings and result.
class Campaign {
 public:
  /// @param settings "dotted.key=value" for every run
  /// @throws UserError where another process works in the folder
  Campaign(std::filesystem::path folder, std::vector<Cell> cells,
           std::vector<std::string> settings);

  /// Runs that are there, whole and of these settings. One that is whole and of others is an error:
  /// UserError names it and the first key that differs.
  bool done(const Cell& cell) const;

  /// Runs what is missing, in order; a run that was cut off is finished. `after` is told of each
  /// cell once it is done. Cells that could not be finished are left out and returned.
  /// @throws Interrupted after Ctrl-C; the same call goes on from there
  std::vector<std::string> run(bool quiet, const std::function<void(const Cell&)>& after);

  Outcomes outcomes() const;
  /// By foot.
  std::vector<std::pair<std::string, std::string>> geometry_hashes() const;

  const std::vector<Cell>& cells() const { return cells_; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path place(const Cell& cell) const { return folder_ / "cells" / cell.id(); }
  std::filesystem::path seal(const Cell& cell) const {
    return folder_ / "cells" / (cell.id() + ".json");
  }
  std::vector<std::string> overrides(const Cell& cell) const;
  void write_seal(const Cell& cell) const;
  bool can_be_resumed(const Cell& cell) const;
  bool try_cell(const Cell& cell, bool quiet, std::string& why_not) const;

  std::filesystem::path folder_;
  std::vector<Cell> cells_;
  std::vector<std::string> settings_;
  FolderLock lock_;
};

}  // namespace hoof::tools
