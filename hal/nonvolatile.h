// Flash memory that keeps its words without power: read, program, erase.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hoof::hal {

enum class FlashResult : std::uint8_t {
  kOk = 0,
  kOutOfRange,  // no such sector or word; nothing was done
  kNeedsErase,  // the value has a 1 where the word has a 0; nothing was done
  kFailed,      // the device reported an error; the word or sector may hold anything
};

/// Sectors of 4-byte words. A sector is erased as a whole, to all ones; programming a word can only
/// clear bits. Every word is programmed once between two erases, except that it may always be
/// programmed to 0: flash with error correction allows no more than that.
///
/// Both operations stall a core that runs from the same bank. On an STM32F405 (DS8626, 5.3.12) a
/// word takes 16 us, at most 100; erasing a 16 KB sector 0.25 s, at most 0.5, a 128 KB sector up to
/// 2 s. So a running foot may program a few words a tick, and erase only in mode off, where no
/// drive waits for a command. A sector lasts 10,000 erases.
///
/// When the power fails, the word being programmed holds any mix of old and new bits, the sector
/// being erased anything. Such bits may even read differently from one time to the next.
class Nonvolatile {
 public:
  using Word = std::uint32_t;
  static constexpr std::size_t kWordBytes = sizeof(Word);
  static constexpr Word kErased = 0xFFFF'FFFF;

  virtual std::size_t sector_count() const = 0;
  /// Size of a sector in words; sizes may differ. 0 when there is no such sector.
  virtual std::size_t sector_words(std::size_t sector) const = 0;

  /// kErased beyond the end.
  virtual Word read(std::size_t sector, std::size_t word) const = 0;
  virtual FlashResult program(std::size_t sector, std::size_t word, Word value) = 0;
  virtual FlashResult erase(std::size_t sector) = 0;

 protected:
  ~Nonvolatile() = default;
};

}  // namespace hoof::hal
