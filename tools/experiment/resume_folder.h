#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tools/run/folder_lock.h"

namespace hoof::tools {

/// One line for the user: the command that finishes the run.
std::string resume_command(const std::string& experiment, const std::filesystem::path& folder);

/// resume_path(run): the settings of an unfinished run as they were resolved, which program ran it,
/// and (written by others) the ground's journal and checkpoints. Locked while a process works in
/// it. At the end the folder is removed unless there is a checkpoint in it: without one there is
/// nothing to lose. Failures throw UserError with the path and the reason.
class ResumeFolder {
 public:
  /// For a new run with the final path `run`. A folder without a checkpoint is taken over, one with
  /// a checkpoint only if `force` is set. Null where another process works in it. At its end,
  /// the new folder is removed again if no checkpoint came into it: there is nothing to lose.
  static std::unique_ptr<ResumeFolder> begin(const std::filesystem::path& run,
                                             const std::string& experiment,
                                             const std::string& settings_toml, bool force);

  /// The folder of a run that was cut off; "<run>" stands for "<run>.resume".
  /// @throws UserError also where it is another experiment's, another program's or in use
  static std::unique_ptr<ResumeFolder> open(const std::filesystem::path& folder,
                                            const std::string& experiment);

  ~ResumeFolder();
  ResumeFolder(const ResumeFolder&) = delete;
  ResumeFolder& operator=(const ResumeFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path run_path() const;
  std::filesystem::path settings_file() const;
  std::string settings_toml() const;
  /// Of settings and program, in one line: runs with the same key go the same way.
  std::string key() const;
  bool has_checkpoint() const;

  /// The run is finished.
  void remove();

 private:
  explicit ResumeFolder(std::filesystem::path path);

  std::filesystem::path path_;  // empty once removed
  FolderLock lock_;
  bool is_new_ = false;
};

}  // namespace hoof::tools
