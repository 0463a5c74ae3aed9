// The flash of the part: the image's sectors, which only a programmer writes, and the three sectors
// of data, which the image programs and erases by the part's own rules.
//
// Source: RM0090 rev. 19, 3.6 to 3.9; times DS8626, 5.3.12.
#pragma once

#include <cstdint>
#include <functional>

#include "hal/in_process/ram_flash.h"
#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class FlashController final : public Peripheral {
 public:
  static constexpr std::uint32_t kDataStart = 0x0800'4000;  // sectors 1 to 3, 16 KB each
  static constexpr std::uint32_t kSectorBytes = 16 * 1024;
  static constexpr std::uint32_t kDataBytes = 3 * kSectorBytes;
  static constexpr Cycles kWordTime = 16 * kCyclesPerMicrosecond;
  static constexpr Cycles kEraseTime = 250 * kCyclesPerMillisecond;

  /// @param words what the sectors of data hold; outlives the part and its resets
  /// @param spend lets time pass for the core
  FlashController(hal::RamFlash& words, const BoardTime& time, std::function<void(Cycles)> spend)
      : words_(words), time_(time), spend_(std::move(spend)) {}

  const char* name() const override { return "FLASH"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  // The sectors of data as memory; offsets from kDataStart.
  std::uint32_t read_word(std::uint32_t offset) const;
  /// @throws hal::PowerCut where the supply fails in it
  void program_word(std::uint32_t offset, std::uint32_t value);

 private:
  bool busy() const { return time_.now < ready_; }
  void write_key(std::uint32_t key);
  void write_control(std::uint32_t value);
  void erase(std::uint32_t sector);

  hal::RamFlash& words_;
  const BoardTime& time_;
  std::function<void(Cycles)> spend_;
  std::uint32_t access_ = 0;
  std::uint32_t status_ = 0;
  std::uint32_t control_ = 0;
  bool first_key_ = false;
  bool key_lost_ = false;  // a wrong key locks until the next reset
  Cycles ready_ = 0;
};

}  // namespace hoof::tools::emulator
