#include "tools/run/output_file.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include "tools/run/errors.h"

namespace hoof::tools {

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (file_ == nullptr) fail("open");
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("write");
}

void OutputFile::close() {
  if (file_ == nullptr) return;
  // Buffered bytes meet a full disk here, and on some file systems only in fclose.
  const bool flushed = std::fflush(file_) == 0;
  const int flush_error = errno;
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!flushed) errno = flush_error;
  if (!flushed || !closed) fail("write");
}

void OutputFile::fail(const char* action) const {
  throw UserError(path_.string() + ": cannot " + action + ": " + std::strerror(errno));
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.close();
}

std::string read_file(const std::filesystem::path& path) {
  const auto fail = [&path](int error) {
    throw UserError(path.string() + ": cannot read: " + std::strerror(error));
  };
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) fail(errno);
  std::string text;
  char block[1 << 16];
  std::size_t count = 0;
  while ((count = std::fread(block, 1, sizeof block, file)) > 0) text.append(block, count);
  const int error = std::ferror(file) != 0 ? errno : 0;  // a folder opens but does not read
  std::fclose(file);
  if (error != 0) fail(error);
  return text;
}

}  // namespace hoof::tools
