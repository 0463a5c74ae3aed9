// The folder that a command of the mismatch tool answers into.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/run/folder_lock.h"

namespace hoof::tools {

/// Files are written into a hidden folder inside and renamed to their places by commit(), so that
/// nothing half-written stands there; without commit() nothing is left. Unlike a run's folder
/// (tools/run/run_folder.h) it may hold other files, which stay.
/// All failures throw UserError.
class AnswerFolder {
 public:
  /// Refuses at once, before any work is done, a folder that holds an earlier answer unless
  /// `force` is set.
  /// @param last the file whose presence says that the answer is whole
  AnswerFolder(const std::filesystem::path& folder, std::string last, bool force);
  ~AnswerFolder();
  AnswerFolder(const AnswerFolder&) = delete;
  AnswerFolder& operator=(const AnswerFolder&) = delete;

  /// @param name without folders
  void write(const std::string& name, std::string_view text);
  /// A file that an earlier answer may have and this one has not: removed by commit().
  void leave_out(const std::string& name) { left_out_.push_back(name); }
  void commit();

 private:
  void remove_abandoned() const;

  std::filesystem::path folder_, working_;
  std::string last_;
  bool made_folder_ = false;
  std::vector<std::string> names_, left_out_;
  std::optional<FolderLock> lock_;  // tells others that this answer is still being written
};

}  // namespace hoof::tools
