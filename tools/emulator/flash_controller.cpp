#include "tools/emulator/flash_controller.h"

#include <algorithm>
#include <cstring>

namespace hoof::tools::emulator {
namespace {

enum Offset { kAccess = 0x00, kKey = 0x04, kStatus = 0x0C, kControl = 0x10 };

constexpr std::uint32_t kKey1 = 0x4567'0123, kKey2 = 0xCDEF'89AB;
constexpr std::uint32_t kEndOfOperation = 1u << 0, kParallelism = 1u << 6, kSequence = 1u << 7,
                        kBusy = 1u << 16;
constexpr std::uint32_t kErrors = 0xF2;
constexpr std::uint32_t kProgram = 1u << 0, kSectorErase = 1u << 1, kMassErase = 1u << 2,
                        kWidth = 3u << 8, kBy32 = 2u << 8, kStart = 1u << 16, kLock = 1u << 31;

/// The core's time is not counted in lock-step; so that waiting ends, each look at a busy flash is
/// taken to last this long.
constexpr Cycles kLook = 10 * kCyclesPerMicrosecond;

constexpr std::size_t kFirstSlot = 3;  // of the sectors that outlive the part
constexpr std::uint32_t kFirstSlotOfPart = 5;

}  // namespace

void FlashController::reset() {
  access_ = 0;
  status_ = 0;
  control_ = kLock;
  first_key_ = key_lost_ = false;
  ready_ = 0;
  show_slots();
}

FlashController::Place FlashController::place_of(std::uint32_t address) {
  if (address < kSlotsStart) {
    const std::uint32_t offset = address - kDataStart;
    return {offset / kSectorBytes, offset % kSectorBytes / 4};
  }
  const std::uint32_t offset = address - kSlotsStart;
  return {kFirstSlot + offset / kSlotBytes, offset % kSlotBytes / 4};
}

void FlashController::show(std::size_t slot, std::size_t word) {
  const std::uint32_t value = words_.read(kFirstSlot + slot, word);
  std::memcpy(&slots_[slot * kSlotBytes + 4 * word], &value, 4);
}

void FlashController::show_slots() {
  for (std::size_t slot = 0; slot < 2; ++slot) {
    for (std::size_t word = 0; word < kSlotBytes / 4; ++word) show(slot, word);
  }
}

void FlashController::write_key(std::uint32_t key) {
  const bool right = key == (first_key_ ? kKey2 : kKey1);
  if (!right || (control_ & kLock) == 0) {
    key_lost_ = true;
    control_ |= kLock;
  } else if (first_key_ && !key_lost_) {
    control_ &= ~kLock;
  }
  first_key_ = right && !first_key_;
}

std::uint32_t FlashController::read(std::uint32_t offset) {
  switch (offset) {
    case kAccess:
      return access_;
    case kStatus:
      if (!busy()) return status_;
      spend_(std::min(kLook, ready_ - time_.now));
      return status_ | kBusy;
    case kControl:
      return control_ & ~kStart;
    default:
      no_such_register(offset);
  }
}

void FlashController::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case kAccess:
      access_ = value;
      return;
    case kKey:
      return write_key(value);
    case kStatus:
      status_ &= ~(value & (kErrors | kEndOfOperation));
      return;
    case kControl:
      return write_control(value);
    default:
      no_such_register(offset);
  }
}

void FlashController::write_control(std::uint32_t value) {
  if ((control_ & kLock) != 0) return;  // as the part: locked, it takes nothing
  if (busy()) throw EmulatorError("FLASH: CR written while an operation runs");
  control_ = value & ~kStart;
  if ((value & kStart) == 0) return;
  if ((value & kMassErase) != 0) throw EmulatorError("FLASH: the image erases all of itself");
  if ((value & kSectorErase) == 0 || (value & kProgram) != 0) {
    status_ |= kSequence;
    return;
  }
  erase(value >> 3 & 0xF);
}

void FlashController::erase(std::uint32_t sector) {
  const bool data = sector >= 1 && sector <= 3;
  const bool slot = sector == kFirstSlotOfPart || sector == kFirstSlotOfPart + 1;
  if (!data && !slot) {
    throw EmulatorError("FLASH: the image erases sector " + std::to_string(sector) +
                        "; parameters and fault log are in 1 to 3, images in 5 and 6");
  }
  if ((control_ & kWidth) != kBy32) {
    status_ |= kParallelism;
    return;
  }
  ready_ = time_.now + (data ? kEraseTime : kSlotEraseTime);
  words_.erase(data ? sector - 1 : kFirstSlot + sector - kFirstSlotOfPart);
  if (slot) show_slots();
}

std::uint32_t FlashController::read_word(std::uint32_t address) const {
  const Place place = place_of(address);
  return words_.read(place.sector, place.word);
}

void FlashController::put_word(std::uint32_t address, std::uint32_t value) {
  const Place place = place_of(address);
  if (value != hal::Nonvolatile::kErased) words_.program(place.sector, place.word, value);
}

void FlashController::program_word(std::uint32_t address, std::uint32_t value) {
  if ((control_ & kLock) != 0 || (control_ & kProgram) == 0) {
    status_ |= kSequence;
    return;
  }
  if ((control_ & kWidth) != kBy32) {
    status_ |= kParallelism;
    return;
  }
  if (busy()) throw EmulatorError("FLASH: a word is written while an operation runs");
  ready_ = time_.now + kWordTime;
  // Programming can only clear bits; the part does not complain.
  const Place place = place_of(address);
  words_.program(place.sector, place.word, value & read_word(address));
  if (place.sector >= kFirstSlot) show(place.sector - kFirstSlot, place.word);
}

}  // namespace hoof::tools::emulator
