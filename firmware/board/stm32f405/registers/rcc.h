// Reset and clock control.
//
// Sources: RM0090 rev. 19, 7.3; checked against the device header of ST's cmsis_device_f4
// (stm32f405xx.h, RCC_TypeDef and the bits RCC_*).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct RccRegisters {
  hal::Register CR;
  hal::Register PLLCFGR;
  hal::Register CFGR;
  std::array<hal::Register, 9> reserved_0C;
  hal::Register AHB1ENR;
  std::array<hal::Register, 3> reserved_34;
  hal::Register APB1ENR;
  hal::Register APB2ENR;
  std::array<hal::Register, 11> reserved_48;
  hal::Register CSR;
};

static_assert(offsetof(RccRegisters, AHB1ENR) == 0x30);
static_assert(offsetof(RccRegisters, APB1ENR) == 0x40);
static_assert(offsetof(RccRegisters, CSR) == 0x74);

namespace rcc {

// CR
inline constexpr std::uint32_t kInternalReady = 1u << 1;    // HSIRDY
inline constexpr std::uint32_t kInternalOn = 1u << 0;       // HSION
inline constexpr std::uint32_t kCrystalOn = 1u << 16;       // HSEON
inline constexpr std::uint32_t kCrystalReady = 1u << 17;    // HSERDY
inline constexpr std::uint32_t kCrystalWatched = 1u << 19;  // CSSON
inline constexpr std::uint32_t kPllOn = 1u << 24;
inline constexpr std::uint32_t kPllReady = 1u << 25;

// PLLCFGR: input / M * N / P to the core, input / M * N / Q (48 MHz, unused here)
constexpr std::uint32_t pll(std::uint32_t m, std::uint32_t n, std::uint32_t p, std::uint32_t q) {
  return m | (n << 6) | ((p / 2 - 1) << 16) | (q << 24);
}
inline constexpr std::uint32_t kPllFromCrystal = 1u << 22;

// CFGR
inline constexpr std::uint32_t kSwitchMask = 3u;
inline constexpr std::uint32_t kSwitchInternal = 0u;
inline constexpr std::uint32_t kSwitchPll = 2u;
inline constexpr std::uint32_t kSwitchedMask = 3u << 2;
inline constexpr std::uint32_t kSwitchedPll = 2u << 2;
inline constexpr std::uint32_t kApb1By4 = 5u << 10;
inline constexpr std::uint32_t kApb2By2 = 4u << 13;

// AHB1ENR, APB1ENR
inline constexpr std::uint32_t kPortA = 1u << 0;
inline constexpr std::uint32_t kPortB = 1u << 1;
inline constexpr std::uint32_t kPortC = 1u << 2;
inline constexpr std::uint32_t kCan1 = 1u << 25;
inline constexpr std::uint32_t kCan2 = 1u << 26;
inline constexpr std::uint32_t kPower = 1u << 28;
inline constexpr std::uint32_t kUsart2 = 1u << 17;
// APB2ENR
inline constexpr std::uint32_t kTimer1 = 1u << 0;
inline constexpr std::uint32_t kUsart1 = 1u << 4;
inline constexpr std::uint32_t kAdc1 = 1u << 8;

// CSR
inline constexpr std::uint32_t kClearResetFlags = 1u << 24;  // RMVF
inline constexpr std::uint32_t kBrownOutReset = 1u << 25;
inline constexpr std::uint32_t kPinReset = 1u << 26;
inline constexpr std::uint32_t kPowerOnReset = 1u << 27;
inline constexpr std::uint32_t kSoftwareReset = 1u << 28;
inline constexpr std::uint32_t kIndependentWatchdogReset = 1u << 29;
inline constexpr std::uint32_t kWindowWatchdogReset = 1u << 30;
inline constexpr std::uint32_t kLowPowerReset = 1u << 31;

}  // namespace rcc
}  // namespace hoof::firmware::stm32f405
