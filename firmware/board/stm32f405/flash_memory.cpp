#include "firmware/board/stm32f405/flash_memory.h"

#include "hal/interrupt_lock.h"

#if defined(__arm__)
/// Runs from RAM: the flash cannot be read while it erases itself.
#define HOOF_IN_RAM [[gnu::section(".ramfunc"), gnu::noinline, gnu::long_call]]
#else
#define HOOF_IN_RAM
#endif

namespace hoof::firmware::stm32f405 {
namespace {

using hal::FlashResult;

/// 100 us at most for a word; the core stalls in between, so that a look or two see the end of it.
constexpr std::uint32_t kProgramTries = 20'000;

/// Ends the wait where no tick comes: for each millisecond that it may take, at 168 MHz, where a
/// look takes some 20 cycles.
constexpr std::uint32_t kEraseTriesPer_ms = 10'000;
/// An erase that may outlast the watchdog's long time feeds it this often.
constexpr std::uint32_t kFeedPeriod_ms = 512;

}  // namespace

FlashMemory::Word FlashMemory::read(std::size_t sector, std::size_t word) const {
  return exists(sector, word) ? at(sector, word).read() : kErased;
}

FlashResult FlashMemory::program(std::size_t sector, std::size_t word, Word value) {
  if (!exists(sector, word)) return FlashResult::kOutOfRange;
  hal::Register& target = at(sector, word);
  if ((value & ~target.read()) != 0) return FlashResult::kNeedsErase;
  if (!unlock()) return FlashResult::kFailed;
  registers_.CR.write(flash::kProgram | flash::kBy32Bits);
  target.write(value);
  return finish() && target.read() == value ? FlashResult::kOk : FlashResult::kFailed;
}

FlashResult FlashMemory::erase(std::size_t sector) {
  if (sector >= area_.sectors) return FlashResult::kOutOfRange;
  if (!unlock()) return FlashResult::kFailed;
  const Watchdog::Time former = watchdog_.time();
  watchdog_.set(Watchdog::Time::kStart);
  const auto number = area_.first_sector + static_cast<std::uint32_t>(sector);
  wait_for_erase(flash::kSectorErase | flash::kBy32Bits | number << flash::kSectorShift);
  const bool done = finish();
  forget_cached_data();
  watchdog_.set(former);
  return done ? FlashResult::kOk : FlashResult::kFailed;
}

/// Ready for an operation, errors of former ones forgotten.
bool FlashMemory::unlock() {
  const auto idle = [this] { return !registers_.SR.has(flash::kBusy); };
  if (!hal::wait_until(kProgramTries, idle)) return false;
  registers_.SR.write(flash::kErrors | flash::kEndOfOperation);
  // Keys written to an unlocked register lock it until the next reset.
  if (registers_.CR.has(flash::kLock)) {
    registers_.KEYR.write(flash::kKey1);
    registers_.KEYR.write(flash::kKey2);
  }
  return !registers_.CR.has(flash::kLock);
}

/// Waits for the end of the operation and locks again. @return whether it went well
bool FlashMemory::finish() {
  const auto idle = [this] { return !registers_.SR.has(flash::kBusy); };
  const bool done = hal::wait_until(kProgramTries, idle);
  const bool good = !registers_.SR.has_any(flash::kErrors);
  registers_.CR.write(flash::kLock);
  return done && good;
}

HOOF_IN_RAM void FlashMemory::wait_for_erase(std::uint32_t command) {
  const hal::InterruptLock lock;  // their handlers are in flash
  registers_.CR.write(command);
  registers_.CR.write(command | flash::kStart);
  const std::uint32_t longest_ms = area_.longest_erase_ms;
  const std::uint32_t tries = longest_ms * kEraseTriesPer_ms;
  std::uint32_t milliseconds = 0;
  for (std::uint32_t i = 0; i < tries && milliseconds < longest_ms; ++i) {
    if (!registers_.SR.has(flash::kBusy)) return;
    if (!clock_.take_pending_tick()) continue;
    ++milliseconds;
    if (longest_ms > kFeedPeriod_ms * 2 && milliseconds % kFeedPeriod_ms == 0) watchdog_.feed();
  }
}

/// The data cache may still hold words from before the erase (RM0090, 3.6).
void FlashMemory::forget_cached_data() {
  if (!registers_.ACR.has(flash::kDataCache)) return;
  registers_.ACR.clear(flash::kDataCache);
  registers_.ACR.set(flash::kDataCacheReset);
  registers_.ACR.clear(flash::kDataCacheReset);
  registers_.ACR.set(flash::kDataCache);
}

}  // namespace hoof::firmware::stm32f405
