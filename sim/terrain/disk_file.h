// An open file whose bytes can be made sure of (fsync), which C++ streams do not offer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace hoof::sim {

/// Every failure throws std::filesystem::filesystem_error with the path and the cause.
class DiskFile {
 public:
  enum class Mode {
    kRead,
    kCreate,  ///< for writing, emptied where it exists
    kUpdate,  ///< for writing into what may be there
  };

  DiskFile(std::filesystem::path path, Mode mode);
  ~DiskFile();
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;

  void write(std::string_view bytes);
  /// @return how many bytes there were, fewer than asked for at the end of the file
  std::size_t read(void* bytes, std::size_t size);
  /// Cuts the file off at `size` bytes and goes there.
  void cut(std::uint64_t size);
  /// Returns once all of it is on the disk.
  void sync();

 private:
  [[noreturn]] void fail(const char* action) const;

  std::filesystem::path path_;
  int fd_;
};

/// Has the names of files that were made or renamed in the folder on the disk.
void sync_folder(const std::filesystem::path& folder);

}  // namespace hoof::sim
