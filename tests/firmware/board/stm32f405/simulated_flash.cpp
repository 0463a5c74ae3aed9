#include "tests/firmware/board/stm32f405/simulated_flash.h"

namespace hoof::tests {

namespace flash = firmware::stm32f405::flash;
namespace scb_bits = firmware::stm32f405::scb;
using hal::Register;

SimulatedFlash::SimulatedFlash() {
  registers.CR.store(flash::kLock);
  registers.ACR.store(flash::kLatency168MHz | flash::kDataCache | flash::kInstructionCache);
  for (Register& word : words) {
    word.store(0xFFFF'FFFF);
    access.when_written(word, [this](Register& r, std::uint32_t v) { write_word(r, v); });
  }
  access.when_written(registers.KEYR, [this](Register&, std::uint32_t value) {
    const bool right = value == (keys_ == 0 ? 0x4567'0123u : 0xCDEF'89ABu);
    if (!right || (registers.CR.stored() & flash::kLock) == 0) dead_until_reset_ = true;
    keys_ = right ? (keys_ + 1) % 2 : 0;
    if (right && keys_ == 0 && !dead_until_reset_) registers.CR.store(0);
  });
  access.when_written(registers.SR, [this](Register& r, std::uint32_t value) {
    r.store(r.stored() & ~(value & 0xF3));
  });
  access.when_read(registers.SR, [this](Register&) { return read_status(); });
  access.when_written(registers.CR, [this](Register&, std::uint32_t v) { write_control(v); });
  access.when_read(scb.ICSR, [](Register& r) { return r.stored(); });
  access.when_written(scb.ICSR, [](Register& r, std::uint32_t value) {
    if ((value & scb_bits::kClearPendingTick) != 0) r.store(r.stored() & ~scb_bits::kPendingTick);
  });
  watchdog.start(firmware::stm32f405::Watchdog::Time::kTick);
  access.when_written(iwdg.RLR, [this](Register& r, std::uint32_t value) {
    r.store(value);
    watchdog_log.push_back("reload " + std::to_string(value));
  });
  access.when_written(iwdg.KR, [this](Register&, std::uint32_t value) {
    if (value == 0xAAAA) watchdog_log.push_back("feed");
  });
}

void SimulatedFlash::write_control(std::uint32_t value) {
  if ((registers.CR.stored() & flash::kLock) != 0) return;
  registers.CR.store(value & ~flash::kStart);
  const bool erases =
      (value & (flash::kStart | flash::kSectorErase)) == (flash::kStart | flash::kSectorErase);
  if (!erases) return;
  erasing_ = static_cast<int>(value >> 3 & 0xF);
  erase_left_ms_ = erase_ms;
  registers.SR.store(registers.SR.stored() | flash::kBusy);
}

void SimulatedFlash::write_word(Register& word, std::uint32_t value) {
  const std::uint32_t control = registers.CR.stored();
  if ((control & flash::kLock) != 0 || (control & flash::kProgram) == 0) {
    registers.SR.store(registers.SR.stored() | flash::kSequenceError);
    return;
  }
  if ((control >> 8 & 3) != 2) {
    registers.SR.store(registers.SR.stored() | flash::kParallelismError);
    return;
  }
  ++programs;
  registers.SR.store(registers.SR.stored() | next_error);
  if (next_error == 0) word.store(word.stored() & value);
  next_error = 0;
}

/// Each look at it takes a tenth of a millisecond here.
std::uint32_t SimulatedFlash::read_status() {
  if (erasing_ >= 0) {
    tick_phase_ms_ += 0.1;
    if (tick_phase_ms_ >= 0.95) {
      tick_phase_ms_ = 0;
      if (tick_runs) scb.ICSR.store(scb.ICSR.stored() | scb_bits::kPendingTick);
    }
    erase_left_ms_ -= 0.1;
    if (erase_left_ms_ <= 0 && !never_done) {
      erased_sectors.push_back(erasing_);
      registers.SR.store((registers.SR.stored() & ~flash::kBusy) | next_error);
      const auto first = static_cast<std::size_t>(erasing_ - 1) * FlashMemory::kSectorWords;
      // Sectors of images have no words here.
      const bool data = first < words.size();
      for (std::size_t i = 0; data && next_error == 0 && i < FlashMemory::kSectorWords; ++i) {
        words[first + i].store(0xFFFF'FFFF);
      }
      next_error = 0;
      erasing_ = -1;
    }
  }
  return registers.SR.stored();
}

}  // namespace hoof::tests
