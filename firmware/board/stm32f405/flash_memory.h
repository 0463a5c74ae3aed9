// The board's own flash as hal::Nonvolatile: an area of it, sectors of one size.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/board/stm32f405/registers/flash.h"
#include "firmware/board/stm32f405/system_clock.h"
#include "firmware/board/stm32f405/watchdog.h"
#include "hal/nonvolatile.h"

namespace hoof::firmware::stm32f405 {

/// Sectors of one size that lie one behind the other (RM0090, 3.4).
struct FlashArea {
  std::uint32_t first_sector;  // of the part; sector 0 of the area
  std::size_t sectors;
  std::size_t sector_words;
  std::uint32_t longest_erase_ms;  // then an erase is given up
};

class FlashMemory final : public hal::Nonvolatile {
 public:
  static constexpr std::size_t kSectors = 3;
  static constexpr std::size_t kSectorWords = 16 * 1024 / kWordBytes;
  /// Sectors 1 to 3: two copies of the parameters, the fault log. The data sheet's worst is 500 ms
  /// for one; the watchdog's long time is 1 s at least.
  static constexpr FlashArea kData{1, kSectors, kSectorWords, 800};
  /// Sectors 5 and 6: the two images. 2 s at worst for one.
  static constexpr FlashArea kImages{5, 2, 128 * 1024 / kWordBytes, 2500};

  /// @param words the first word of the first sector
  FlashMemory(FlashRegisters& registers, hal::Register* words, Watchdog& watchdog,
              SystemClock& clock, const FlashArea& area = kData)
      : registers_(registers), words_(words), watchdog_(watchdog), clock_(clock), area_(area) {}

  std::size_t sector_count() const override { return area_.sectors; }
  std::size_t sector_words(std::size_t sector) const override {
    return sector < area_.sectors ? area_.sector_words : 0;
  }
  Word read(std::size_t sector, std::size_t word) const override;

  /// The core stalls for 16 us, at most 100: interrupts wait.
  hal::FlashResult program(std::size_t sector, std::size_t word, Word value) override;

  /// Up to half a second, of an image's sector two, in which no interrupt runs: frames beyond the
  /// peripheral's FIFOs are lost, time goes on, the watchdog is set to its long time and back.
  hal::FlashResult erase(std::size_t sector) override;

 private:
  bool exists(std::size_t sector, std::size_t word) const {
    return sector < area_.sectors && word < area_.sector_words;
  }
  hal::Register& at(std::size_t sector, std::size_t word) const {
    return words_[sector * area_.sector_words + word];
  }
  bool unlock();
  bool finish();
  void wait_for_erase(std::uint32_t command);
  void forget_cached_data();

  FlashRegisters& registers_;
  hal::Register* words_;
  Watchdog& watchdog_;
  SystemClock& clock_;
  FlashArea area_;
};

}  // namespace hoof::firmware::stm32f405
