#include "firmware/board/stm32f405/clock_tree.h"

namespace hoof::firmware::stm32f405 {
namespace {

// A look takes at least 8 cycles of 16 MHz, 0.5 us.
/// A crystal starts in 2 ms as a rule (DS8626, HSE characteristics); this is 100 ms at least.
constexpr std::uint32_t kCrystalTries = 200'000;
/// The PLL locks in 0.3 ms at most (DS8626, PLL characteristics), the switch in a
/// few cycles; this is 2.5 ms.
constexpr std::uint32_t kPllTries = 5'000;

// 2 MHz into the PLL, as RM0090 7.3.2 recommends against jitter; 336 MHz; 168 MHz and 48 MHz out.
constexpr std::uint32_t kPllOf8MHz = rcc::pll(4, 168, 2, 7) | rcc::kPllFromCrystal;
constexpr std::uint32_t kPllOf16MHz = rcc::pll(8, 168, 2, 7);
static_assert(8'000'000u / 4 * 168 / 2 == 168'000'000u);
static_assert(16'000'000u / 8 * 168 / 2 == 168'000'000u);

constexpr std::uint32_t kCaches = flash::kPrefetch | flash::kInstructionCache | flash::kDataCache;

bool start_crystal(RccRegisters& rcc) {
  rcc.CR.set(rcc::kCrystalOn);
  if (hal::wait_until(kCrystalTries, [&rcc] { return rcc.CR.has(rcc::kCrystalReady); }))
    return true;
  rcc.CR.clear(rcc::kCrystalOn);
  return false;
}

bool start_pll(RccRegisters& rcc, FlashRegisters& flash, std::uint32_t configuration) {
  rcc.PLLCFGR.write(configuration);
  rcc.CR.set(rcc::kPllOn);
  const bool locked = hal::wait_until(kPllTries, [&rcc] { return rcc.CR.has(rcc::kPllReady); });
  // Slow flash before the fast clock: without its wait states the core would fetch rubbish.
  flash.ACR.change(flash::kLatencyMask, flash::kLatency168MHz | kCaches);
  const bool slowed = hal::wait_until(kPllTries, [&flash] {
    return (flash.ACR.read() & flash::kLatencyMask) == flash::kLatency168MHz;
  });
  if (!locked || !slowed) {
    rcc.CR.clear(rcc::kPllOn);
    return false;
  }
  rcc.CFGR.write(rcc::kApb1By4 | rcc::kApb2By2);
  rcc.CFGR.change(rcc::kSwitchMask, rcc::kSwitchPll);
  return hal::wait_until(
      kPllTries, [&rcc] { return (rcc.CFGR.read() & rcc::kSwitchedMask) == rcc::kSwitchedPll; });
}

void fall_back_to_internal(RccRegisters& rcc) {
  rcc.CFGR.write(rcc::kSwitchInternal);  // all buses undivided
  rcc.CR.clear(rcc::kPllOn);
}

}  // namespace

Clocks start_clocks(RccRegisters& rcc, PwrRegisters& pwr, FlashRegisters& flash) {
  rcc.APB1ENR.set(rcc::kPower);
  rcc.APB1ENR.read();  // a peripheral answers some cycles after its clock was switched on (ES0182)
  pwr.CR.set(pwr::kFullVoltage);
  if (start_crystal(rcc) && start_pll(rcc, flash, kPllOf8MHz)) {
    rcc.CR.set(rcc::kCrystalWatched);
    return {ClockSource::kCrystalPll, 168'000'000, 42'000'000, 84'000'000};
  }
  fall_back_to_internal(rcc);
  if (start_pll(rcc, flash, kPllOf16MHz)) {
    return {ClockSource::kInternalPll, 168'000'000, 42'000'000, 84'000'000};
  }
  fall_back_to_internal(rcc);
  return {};
}

bool start_internal_clock(RccRegisters& rcc, PwrRegisters& pwr, FlashRegisters& flash) {
  rcc.APB1ENR.set(rcc::kPower);
  rcc.APB1ENR.read();
  pwr.CR.set(pwr::kFullVoltage);
  if (start_pll(rcc, flash, kPllOf16MHz)) return true;
  fall_back_to_internal(rcc);
  return false;
}

void stop_internal_clock(RccRegisters& rcc) {
  rcc.CFGR.write(rcc::kSwitchInternal);
  // The PLL may not be stopped while the core runs on it.
  hal::wait_until(kPllTries, [&rcc] { return (rcc.CFGR.read() & rcc::kSwitchedMask) == 0; });
  rcc.CR.clear(rcc::kPllOn);
  hal::wait_until(kPllTries, [&rcc] { return !rcc.CR.has(rcc::kPllReady); });
}

std::optional<std::uint32_t> can_bit_timing(const Clocks& clocks) {
  if (clocks.source != ClockSource::kCrystalPll) return std::nullopt;
  // SJW - 1 = 1, TS2 - 1 = 1, TS1 - 1 = 10, BRP - 1 = 2
  constexpr std::uint32_t kOf42MHz = 1u << 24 | 1u << 20 | 10u << 16 | 2u;
  static_assert(kOf42MHz == 0x011A'0002 && 42'000'000 / 3 / (1 + 11 + 2) == 1'000'000);
  return kOf42MHz;
}

}  // namespace hoof::firmware::stm32f405
