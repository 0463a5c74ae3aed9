#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace hoof::tools {

/// A file being written. Every failure (unwritable folder, full disk) throws a UserError that
/// names the path and the reason; nothing is lost silently.
class OutputFile {
 public:
  /// Creates or replaces the file.
  explicit OutputFile(std::filesystem::path path);

  /// Closes without a check: call close() to learn whether all bytes arrived.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);

  /// Flushes and closes. Harmless when already closed.
  void close();

  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail(const char* action) const;

  std::filesystem::path path_;
  std::FILE* file_;
};

/// Writes a whole file at once.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Reads a whole file; a UserError names the path and the reason where that is impossible.
std::string read_file(const std::filesystem::path& path);

}  // namespace hoof::tools
