#include "hal/in_process/ram_flash.h"

namespace hoof::hal {

RamFlash::RamFlash(std::vector<std::size_t> sector_words, std::uint32_t seed) : random_(seed) {
  for (const std::size_t words : sector_words) sectors_.emplace_back(words);
}

std::size_t RamFlash::sector_words(std::size_t sector) const {
  return sector < sectors_.size() ? sectors_[sector].size() : 0;
}

bool RamFlash::exists(std::size_t sector, std::size_t word) const {
  return word < sector_words(sector);
}

RamFlash::Word RamFlash::read(std::size_t sector, std::size_t word) const {
  if (!exists(sector, word)) return kErased;
  const Cell& cell = sectors_[sector][word];
  if (cell.unstable == 0) return cell.value;
  return cell.value ^ (cell.unstable & random_word());
}

FlashResult RamFlash::program(std::size_t sector, std::size_t word, Word value) {
  if (!exists(sector, word)) return FlashResult::kOutOfRange;
  Cell& target = cell(sector, word);
  if ((value & ~target.value & ~target.unstable) != 0) return FlashResult::kNeedsErase;
  ++programs_;
  if (power_fails()) {
    half_program(target, value);
    throw PowerCut{};
  }
  if (target.worn) return FlashResult::kOk;
  target.value &= value;
  target.unstable &= value;
  return FlashResult::kOk;
}

FlashResult RamFlash::erase(std::size_t sector) {
  if (sector >= sectors_.size()) return FlashResult::kOutOfRange;
  ++erases_;
  if (power_fails()) {
    for (Cell& target : sectors_[sector]) half_erase(target);
    throw PowerCut{};
  }
  for (Cell& target : sectors_[sector]) {
    target.value = kErased;
    target.unstable = 0;
  }
  return FlashResult::kOk;
}

void RamFlash::cut_after(std::size_t operations, CutOutcome outcome) {
  cut_armed_ = true;
  operations_left_ = operations;
  outcome_ = outcome;
}

bool RamFlash::power_fails() {
  if (!cut_armed_ || operations_left_-- > 0) return false;
  cut_armed_ = false;
  return true;
}

/// From half of the bits down to one in 64: a word with a single doubtful bit reads like a whole
/// one half of the time.
RamFlash::Word RamFlash::random_bits() {
  Word bits = random_word();
  for (Word thinner = random_word() % 6; thinner > 0; --thinner) bits &= random_word();
  return bits;
}

void RamFlash::half_program(Cell& cell, Word value) {
  const Word to_clear = (cell.value | cell.unstable) & ~value;
  switch (outcome_) {
    case CutOutcome::kOld:
      break;
    case CutOutcome::kNew:
      cell.value &= ~to_clear;
      cell.unstable &= ~to_clear;
      break;
    case CutOutcome::kMixed: {
      const Word cleared = to_clear & random_word();
      cell.value &= ~cleared;
      cell.unstable &= ~cleared;
      break;
    }
    case CutOutcome::kUnstable:
      cell.unstable |= to_clear & random_bits();
      break;
  }
}

void RamFlash::half_erase(Cell& cell) {
  switch (outcome_) {
    case CutOutcome::kOld:
      break;
    case CutOutcome::kNew:
      cell.value = kErased;
      cell.unstable = 0;
      break;
    case CutOutcome::kMixed: {
      const Word garbage[] = {cell.value, kErased, cell.value | random_word(), random_word()};
      cell.value = garbage[random_word() % 4];
      cell.unstable = 0;
      break;
    }
    case CutOutcome::kUnstable:
      cell.unstable |= ~cell.value & random_bits();
      break;
  }
}

}  // namespace hoof::hal
