#include "hal/file_flash/file_flash.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace hoof::hal {

FileFlash::FileFlash(std::string path, std::size_t sectors, std::size_t sector_words)
    : path_(std::move(path)),
      sectors_(sectors),
      sector_words_(sector_words),
      words_(sectors * sector_words, kErased) {
  file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) throw std::runtime_error(path_ + ": " + std::strerror(errno));
  const std::size_t bytes = words_.size() * kWordBytes;
  struct stat info {};
  const bool known = fstat(file_, &info) == 0;
  const bool fresh = known && info.st_size == 0;
  std::string problem;
  if (!known || (!fresh && std::size_t(info.st_size) != bytes)) {
    problem = "is no flash of " + std::to_string(bytes) + " bytes";
  } else if (fresh ? save(0, words_.size()) != FlashResult::kOk
                   : pread(file_, words_.data(), bytes, 0) != ssize_t(bytes)) {
    problem = std::strerror(errno);
  }
  if (problem.empty()) return;
  close(file_);
  throw std::runtime_error(path_ + ": " + problem);
}

FileFlash::~FileFlash() {
  close(file_);
}

Nonvolatile::Word FileFlash::read(std::size_t sector, std::size_t word) const {
  return exists(sector, word) ? words_[place(sector, word)] : kErased;
}

FlashResult FileFlash::program(std::size_t sector, std::size_t word, Word value) {
  if (!exists(sector, word)) return FlashResult::kOutOfRange;
  Word& cell = words_[place(sector, word)];
  if ((value & ~cell) != 0) return FlashResult::kNeedsErase;
  cell = value;
  return save(place(sector, word), 1);
}

FlashResult FileFlash::erase(std::size_t sector) {
  if (sector >= sectors_) return FlashResult::kOutOfRange;
  std::fill_n(words_.begin() + std::ptrdiff_t(place(sector, 0)), sector_words_, kErased);
  return save(place(sector, 0), sector_words_);
}

FlashResult FileFlash::save(std::size_t first, std::size_t count) {
  const auto bytes = ssize_t(count * kWordBytes);
  const auto offset = off_t(first * kWordBytes);
  const bool written = pwrite(file_, words_.data() + first, std::size_t(bytes), offset) == bytes;
  return written ? FlashResult::kOk : FlashResult::kFailed;
}

}  // namespace hoof::hal
