#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/run/folder_lock.h"

namespace hoof::tools {

/// Where and how a run's folder is to be made.
struct RunFolderOptions {
  std::string experiment;     ///< names the default folder: runs/<experiment>-<date>-<n>
  std::filesystem::path out;  ///< the folder asked for by --out; empty: the default
  bool force = false;         ///< replace an earlier run of the same name
  std::filesystem::path runs_root = "runs";  ///< where default folders are made
};

inline constexpr char kResumeEnding[] = ".resume";

/// Beside a run's final path: where an unfinished run keeps what it takes to finish it after it
/// was cut off. A default name is not given to a new run while this folder is there.
std::filesystem::path resume_path(const std::filesystem::path& run);

/// The folder of one run. All files are written into a hidden sibling of the final path, so that
/// nothing half-written ever stands at the final path; commit() renames it there. Without
/// commit() or keep_as() the destructor removes what was written.
/// Failures throw UserError with the path and the reason.
class RunFolder {
 public:
  /// Refuses at once, before any work is done, if the final path exists and `force` is not set.
  /// `force` replaces run folders and empty folders only, never some other folder. What a killed
  /// run of the same name left half-written is removed.
  explicit RunFolder(RunFolderOptions options);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Path to write the file `name` at, inside the hidden folder.
  std::filesystem::path file(const std::string& name) const { return working_path_ / name; }
  const std::filesystem::path& working_path() const { return working_path_; }
  /// Where commit() will move the run, unless a default name is taken by then.
  const std::filesystem::path& final_path() const { return final_path_; }

  /// Folders of killed runs that were removed.
  const std::vector<std::filesystem::path>& removed() const { return removed_; }

  /// Moves the finished run to its final path and returns that. A default name that another run
  /// has taken in the meantime is replaced by the next free one.
  std::filesystem::path commit();

  /// Keeps what exists of an unfinished run beside the final path, under a name that says so,
  /// for instance "...-interrupted", and returns that path.
  std::filesystem::path keep_as(const std::string& ending);

 private:
  std::filesystem::path next_default_path() const;
  void remove_abandoned();
  void make_working_folder();
  void replace(const std::filesystem::path& old_run);

  RunFolderOptions options_;
  std::filesystem::path final_path_;
  std::filesystem::path working_path_;  // empty once renamed
  std::optional<FolderLock> lock_;      // tells others that this run lives
  std::vector<std::filesystem::path> removed_;
};

}  // namespace hoof::tools
