// The board's own flash as hal::Nonvolatile: the three sectors of 16 KB kept for data.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/board/stm32f405/registers/flash.h"
#include "firmware/board/stm32f405/system_clock.h"
#include "firmware/board/stm32f405/watchdog.h"
#include "hal/nonvolatile.h"

namespace hoof::firmware::stm32f405 {

/// Sector i here is sector i + 1 of the part: 0 and 1 hold the parameters, 2 the fault log.
class FlashMemory final : public hal::Nonvolatile {
 public:
  static constexpr std::size_t kSectors = 3;
  static constexpr std::size_t kSectorWords = 16 * 1024 / kWordBytes;
  static constexpr std::uint32_t kFirstSector = 1;

  /// @param words the first word of the first sector
  FlashMemory(FlashRegisters& registers, hal::Register* words, Watchdog& watchdog,
              SystemClock& clock)
      : registers_(registers), words_(words), watchdog_(watchdog), clock_(clock) {}

  std::size_t sector_count() const override { return kSectors; }
  std::size_t sector_words(std::size_t sector) const override {
    return sector < kSectors ? kSectorWords : 0;
  }
  Word read(std::size_t sector, std::size_t word) const override;

  /// The core stalls for 16 us, at most 100: interrupts wait.
  hal::FlashResult program(std::size_t sector, std::size_t word, Word value) override;

  /// Up to half a second, in which no interrupt runs: frames beyond the peripheral's FIFOs are
  /// lost, time goes on, the watchdog is set to its long time and back.
  hal::FlashResult erase(std::size_t sector) override;

 private:
  static bool exists(std::size_t sector, std::size_t word) {
    return sector < kSectors && word < kSectorWords;
  }
  hal::Register& at(std::size_t sector, std::size_t word) const {
    return words_[sector * kSectorWords + word];
  }
  bool unlock();
  bool finish();
  void wait_for_erase(std::uint32_t command);
  void forget_cached_data();

  FlashRegisters& registers_;
  hal::Register* words_;
  Watchdog& watchdog_;
  SystemClock& clock_;
};

}  // namespace hoof::firmware::stm32f405
