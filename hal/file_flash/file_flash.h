// Flash memory in a file, for firmware that runs as a program.
#pragma once

#include <string>
#include <vector>

#include "hal/nonvolatile.h"

namespace hoof::hal {

/// The file holds all sectors one behind the other, as a programmer would read them out of a board.
/// Refuses what real flash cannot do. Every change is in the file when the call returns.
class FileFlash final : public Nonvolatile {
 public:
  /// Opens the file, or makes it, all erased.
  /// @throws std::runtime_error naming the file: cannot be opened or read, has another size
  FileFlash(std::string path, std::size_t sectors, std::size_t sector_words);
  FileFlash(const FileFlash&) = delete;
  FileFlash& operator=(const FileFlash&) = delete;
  ~FileFlash();

  std::size_t sector_count() const override { return sectors_; }
  std::size_t sector_words(std::size_t sector) const override {
    return sector < sectors_ ? sector_words_ : 0;
  }
  Word read(std::size_t sector, std::size_t word) const override;
  FlashResult program(std::size_t sector, std::size_t word, Word value) override;
  FlashResult erase(std::size_t sector) override;

 private:
  bool exists(std::size_t sector, std::size_t word) const {
    return sector < sectors_ && word < sector_words_;
  }
  std::size_t place(std::size_t sector, std::size_t word) const {
    return sector * sector_words_ + word;
  }
  FlashResult save(std::size_t first, std::size_t count);

  std::string path_;
  std::size_t sectors_;
  std::size_t sector_words_;
  std::vector<Word> words_;
  int file_ = -1;
};

}  // namespace hoof::hal
