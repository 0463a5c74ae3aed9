// From the crystal to 168 MHz, or as far as it goes.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/board/stm32f405/registers/flash.h"
#include "firmware/board/stm32f405/registers/pwr.h"
#include "firmware/board/stm32f405/registers/rcc.h"

namespace hoof::firmware::stm32f405 {

enum class ClockSource : std::uint8_t {
  kCrystalPll,   // 8 MHz crystal (HSE), 168 MHz by the PLL
  kInternalPll,  // 16 MHz RC oscillator (HSI), 168 MHz by the PLL: the crystal did not start
  kInternal,     // 16 MHz RC oscillator: the PLL did not lock either
};

/// What runs now.
struct Clocks {
  ClockSource source = ClockSource::kInternal;
  std::uint32_t core_Hz = 16'000'000;
  std::uint32_t apb1_Hz = 16'000'000;
  std::uint32_t apb2_Hz = 16'000'000;
};

/// Every wait in here ends after a counted number of looks. Where the crystal runs, its failing
/// later on raises the NMI (clock security system).
Clocks start_clocks(RccRegisters& rcc, PwrRegisters& pwr, FlashRegisters& flash);

/// For the boot loader, which wants speed and no accuracy, and waits for no crystal: 168 MHz by
/// the internal oscillator and the PLL. @return false where the PLL does not lock: 16 MHz then
bool start_internal_clock(RccRegisters& rcc, PwrRegisters& pwr, FlashRegisters& flash);
/// Back to 16 MHz and no PLL, from where start_clocks() begins.
void stop_internal_clock(RccRegisters& rcc);

/// BTR of a bxCAN for 1 Mbit/s, or nothing where this clock must not drive a bus.
///
/// 42 MHz: BRP 3, 1 + 11 + 2 time quanta, sample point 85.7 %, SJW 2. That tolerates an oscillator
/// error of min(SJW / (20 * 14), 2 / (2 * (13 * 14 - 2))) = 0.56 % (Hartwich and Bassemir, "The
/// configuration of the CAN bit timing", 1999). The internal oscillator is within 1 % at 25 C and
/// within 4 % from -10 to 85 C (DS8626, HSI characteristics): a node on it would destroy the frames
/// of others, the e-stop's among them. So without crystal the foot stays off the bus, and the
/// drives' own time-out of 20 ms holds.
std::optional<std::uint32_t> can_bit_timing(const Clocks& clocks);

}  // namespace hoof::firmware::stm32f405
