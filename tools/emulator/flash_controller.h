// The flash of the part: sectors that only a programmer writes, and those that the image programs
// and erases by the part's own rules: three of data and the two slots of images.
//
// Source: RM0090 rev. 19, 3.6 to 3.9; times DS8626, 5.3.12.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hal/nonvolatile.h"
#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class FlashController final : public Peripheral {
 public:
  static constexpr std::uint32_t kDataStart = 0x0800'4000;  // sectors 1 to 3, 16 KB each
  static constexpr std::uint32_t kSectorBytes = 16 * 1024;
  static constexpr std::uint32_t kDataBytes = 3 * kSectorBytes;
  static constexpr std::uint32_t kSlotsStart = 0x0802'0000;  // sectors 5 and 6, 128 KB each
  static constexpr std::uint32_t kSlotBytes = 128 * 1024;
  static constexpr std::uint32_t kSlotsBytes = 2 * kSlotBytes;
  static constexpr Cycles kWordTime = 16 * kCyclesPerMicrosecond;
  static constexpr Cycles kEraseTime = 250 * kCyclesPerMillisecond;
  static constexpr Cycles kSlotEraseTime = 1000 * kCyclesPerMillisecond;

  /// @param words sectors 0 to 2 the data, 3 and 4 the slots; outlives the part and its resets
  /// @param spend lets time pass for the core
  FlashController(hal::Nonvolatile& words, const BoardTime& time, std::function<void(Cycles)> spend)
      : words_(words), time_(time), spend_(std::move(spend)), slots_(kSlotsBytes, 0xFF) {}

  const char* name() const override { return "FLASH"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  /// Of a sector of data.
  std::uint32_t read_word(std::uint32_t address) const;
  /// In data or a slot. @throws hal::PowerCut where the supply fails in it
  void program_word(std::uint32_t address, std::uint32_t value);

  /// As a programmer does: at once, whatever the registers say.
  void put_word(std::uint32_t address, std::uint32_t value);

  /// Both slots as the core sees them, for it to execute. Bits that are unstable read one way from
  /// a reset to the next.
  std::span<std::uint8_t> slots() { return slots_; }
  /// Takes slots() from what the flash holds.
  void show_slots();

 private:
  struct Place {
    std::size_t sector, word;
  };

  static Place place_of(std::uint32_t address);
  void show(std::size_t slot, std::size_t word);
  bool busy() const { return time_.now < ready_; }
  void write_key(std::uint32_t key);
  void write_control(std::uint32_t value);
  void erase(std::uint32_t sector);

  hal::Nonvolatile& words_;
  const BoardTime& time_;
  std::function<void(Cycles)> spend_;
  std::vector<std::uint8_t> slots_;
  std::uint32_t access_ = 0;
  std::uint32_t status_ = 0;
  std::uint32_t control_ = 0;
  bool first_key_ = false;
  bool key_lost_ = false;  // a wrong key locks until the next reset
  Cycles ready_ = 0;
};

}  // namespace hoof::tools::emulator
