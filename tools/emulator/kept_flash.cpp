#include "tools/emulator/kept_flash.h"

#include <stdexcept>

#include "tools/emulator/flash_controller.h"

namespace hoof::tools::emulator {
namespace {

constexpr std::size_t kPieceWords = FlashController::kSectorBytes / 4;
constexpr std::size_t kSlotPieces = FlashController::kSlotBytes / FlashController::kSectorBytes;

}  // namespace

KeptFlash::KeptFlash(const std::string& path)
    : path_(path),
      sectors_{{0, 1}, {1, 1}, {2, 1}, {3, kSlotPieces}, {3 + kSlotPieces, kSlotPieces}},
      file_(path, 3 + 2 * kSlotPieces, kPieceWords) {}

std::size_t KeptFlash::sector_words(std::size_t sector) const {
  return sector < sectors_.size() ? sectors_[sector].pieces * kPieceWords : 0;
}

KeptFlash::Word KeptFlash::read(std::size_t sector, std::size_t word) const {
  if (word >= sector_words(sector)) return kErased;
  return file_.read(sectors_[sector].first_piece + word / kPieceWords, word % kPieceWords);
}

hal::FlashResult KeptFlash::program(std::size_t sector, std::size_t word, Word value) {
  if (word >= sector_words(sector)) return hal::FlashResult::kOutOfRange;
  const std::size_t piece = sectors_[sector].first_piece + word / kPieceWords;
  return written(file_.program(piece, word % kPieceWords, value));
}

hal::FlashResult KeptFlash::erase(std::size_t sector) {
  if (sector >= sectors_.size()) return hal::FlashResult::kOutOfRange;
  const Sector& s = sectors_[sector];
  for (std::size_t i = 0; i < s.pieces; ++i) written(file_.erase(s.first_piece + i));
  return hal::FlashResult::kOk;
}

hal::FlashResult KeptFlash::written(hal::FlashResult result) const {
  if (result != hal::FlashResult::kFailed) return result;
  throw std::runtime_error(path_ + ": the flash of the board cannot be written");
}

}  // namespace hoof::tools::emulator
