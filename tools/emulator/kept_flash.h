// The flash of a board in a file: what the image writes outlives the program, however it ends.
#pragma once

#include <string>
#include <vector>

#include "hal/file_flash/file_flash.h"

namespace hoof::tools::emulator {

/// Sectors as blank_flash() has them. Every word is in the file once it is programmed, so a program
/// that is killed is a supply that was cut; a sector that is being erased then is erased in part.
class KeptFlash final : public hal::Nonvolatile {
 public:
  /// Opens the file, or makes it, all erased.
  /// @throws std::runtime_error naming the file: cannot be opened or read, has another size
  explicit KeptFlash(const std::string& path);

  std::size_t sector_count() const override { return sectors_.size(); }
  std::size_t sector_words(std::size_t sector) const override;
  Word read(std::size_t sector, std::size_t word) const override;
  /// @throws std::runtime_error where the file cannot be written: no board goes on by a flash that
  /// does not keep what it says
  hal::FlashResult program(std::size_t sector, std::size_t word, Word value) override;
  hal::FlashResult erase(std::size_t sector) override;

 private:
  /// The file has sectors of one size, the larger ones of the board in pieces of it.
  struct Sector {
    std::size_t first_piece, pieces;
  };

  hal::FlashResult written(hal::FlashResult result) const;

  std::string path_;
  std::vector<Sector> sectors_;
  hal::FileFlash file_;
};

}  // namespace hoof::tools::emulator
