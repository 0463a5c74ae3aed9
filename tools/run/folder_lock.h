#pragma once

#include <filesystem>

namespace hoof::tools {

/// Tells whether the process that works in a folder is alive: it holds the folder's lock (flock),
/// which the system lets go of however the process ends. A folder that is renamed stays locked.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Ours now. Where neither held nor taken the file system has no locks: nothing is known.
  bool held() const { return held_; }
  /// Another process, or another lock of this one, has it.
  bool taken() const { return taken_; }

 private:
  int fd_;
  bool held_ = false;
  bool taken_ = false;
};

}  // namespace hoof::tools
