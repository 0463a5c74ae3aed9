// Flash memory simulated in RAM, with a power supply that fails when told to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "hal/nonvolatile.h"

namespace hoof::hal {

/// Thrown by the operation in which the power fails: nothing after it runs, as on a board.
struct PowerCut {};

/// What the operation leaves behind that was under way when the power failed.
enum class CutOutcome : std::uint8_t {
  kOld,       // nothing happened yet
  kNew,       // it was just done
  kMixed,     // programming: each bit old or new; erasing: each word old, erased, mixed or garbage
  kUnstable,  // of the bits that were to change some, many or one, read old or new, anew at every
              // reading; the others are old
};

/// Refuses what real flash cannot do. Same seed, same calls: same contents.
class RamFlash final : public Nonvolatile {
 public:
  /// @param sector_words size of each sector; all start erased
  explicit RamFlash(std::vector<std::size_t> sector_words, std::uint32_t seed = 1);

  std::size_t sector_count() const override { return sectors_.size(); }
  std::size_t sector_words(std::size_t sector) const override;
  Word read(std::size_t sector, std::size_t word) const override;
  FlashResult program(std::size_t sector, std::size_t word, Word value) override;
  FlashResult erase(std::size_t sector) override;

  /// The power fails in the operation (program or erase) after `operations` further ones; it is
  /// back for the one after.
  void cut_after(std::size_t operations, CutOutcome outcome);
  void cancel_cut() { cut_armed_ = false; }

  /// From now on programming this word has no effect, unnoticed by the device: a worn-out cell.
  void wear_out(std::size_t sector, std::size_t word) { cell(sector, word).worn = true; }

  // Since start, cut ones included.
  std::size_t programs() const { return programs_; }
  std::size_t erases() const { return erases_; }
  std::size_t operations() const { return programs_ + erases_; }

 private:
  struct Cell {
    Word value = kErased;
    Word unstable = 0;  // bits that read as chance has it
    bool worn = false;
  };

  bool exists(std::size_t sector, std::size_t word) const;
  Cell& cell(std::size_t sector, std::size_t word) { return sectors_[sector][word]; }
  bool power_fails();
  void half_program(Cell& cell, Word value);
  void half_erase(Cell& cell);
  Word random_word() const { return static_cast<Word>(random_()); }
  Word random_bits();

  std::vector<std::vector<Cell>> sectors_;
  mutable std::mt19937 random_;
  bool cut_armed_ = false;
  std::size_t operations_left_ = 0;
  CutOutcome outcome_ = CutOutcome::kOld;
  std::size_t programs_ = 0;
  std::size_t erases_ = 0;
};

}  // namespace hoof::hal
