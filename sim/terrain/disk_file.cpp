#include "sim/terrain/disk_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace hoof::sim {
namespace {

int flags(DiskFile::Mode mode) {
  switch (mode) {
    case DiskFile::Mode::kRead:
      return O_RDONLY;
    case DiskFile::Mode::kCreate:
      return O_WRONLY | O_CREAT | O_TRUNC;
    case DiskFile::Mode::kUpdate:
      return O_WRONLY | O_CREAT;
  }
  return O_RDONLY;
}

}  // namespace

DiskFile::DiskFile(std::filesystem::path path, Mode mode)
    : path_(std::move(path)), fd_(::open(path_.c_str(), flags(mode) | O_CLOEXEC, 0666)) {
  if (fd_ < 0) fail("open");
}

DiskFile::~DiskFile() {
  ::close(fd_);
}

void DiskFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("write");
    bytes.remove_prefix(std::size_t(n));
  }
}

std::size_t DiskFile::read(void* bytes, std::size_t size) {
  char* const to = static_cast<char*>(bytes);
  std::size_t got = 0;
  while (got < size) {
    const ssize_t n = ::read(fd_, to + got, size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("read");
    if (n == 0) break;
    got += std::size_t(n);
  }
  return got;
}

void DiskFile::cut(std::uint64_t size) {
  if (::ftruncate(fd_, off_t(size)) != 0 || ::lseek(fd_, off_t(size), SEEK_SET) < 0) fail("cut");
}

void DiskFile::sync() {
  if (::fsync(fd_) != 0) fail("write");
}

void DiskFile::fail(const char* action) const {
  throw std::filesystem::filesystem_error(std::string("cannot ") + action, path_,
                                          std::error_code(errno, std::generic_category()));
}

void sync_folder(const std::filesystem::path& folder) {
  DiskFile(folder, DiskFile::Mode::kRead).sync();
}

}  // namespace hoof::sim
