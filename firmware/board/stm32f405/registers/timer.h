// An advanced-control timer, TIM1 or TIM8.
//
// Sources: RM0090 rev. 19, 17.4 (and 17.3.12 for the break); checked against the device header of
// ST's cmsis_device_f4 (stm32f405xx.h, TIM_TypeDef and the bits TIM_*).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct TimerRegisters {
  hal::Register CR1;
  hal::Register CR2;
  hal::Register SMCR;
  hal::Register DIER;
  hal::Register SR;
  hal::Register EGR;
  std::array<hal::Register, 2> CCMR;
  hal::Register CCER;
  hal::Register CNT;
  hal::Register PSC;
  hal::Register ARR;
  hal::Register RCR;
  std::array<hal::Register, 4> CCR;
  hal::Register BDTR;
};

static_assert(offsetof(TimerRegisters, CCER) == 0x20 && offsetof(TimerRegisters, ARR) == 0x2C);
static_assert(offsetof(TimerRegisters, CCR) == 0x34 && offsetof(TimerRegisters, BDTR) == 0x44);

namespace timer {

// CR1
inline constexpr std::uint32_t kCounts = 1u << 0;          // CEN
inline constexpr std::uint32_t kReloadBuffered = 1u << 7;  // ARPE

// DIER, SR; flags are cleared by writing 0
inline constexpr std::uint32_t kBreak = 1u << 7;  // BIE, BIF

// EGR
inline constexpr std::uint32_t kUpdate = 1u << 0;  // UG: takes over prescaler and buffers

// CCMR1: channel 1 high while the counter is below CCR1, which is buffered
inline constexpr std::uint32_t kWave = 6u << 4 | 1u << 3;

// CCER
inline constexpr std::uint32_t kChannel1 = 1u << 0;  // CC1E

// BDTR. BKP = 0: the break is a low level.
inline constexpr std::uint32_t kLockAll = 3u << 8;      // LOCK, until the next reset
inline constexpr std::uint32_t kIdleDriven = 1u << 10;  // OSSI
inline constexpr std::uint32_t kBreakOn = 1u << 12;     // BKE
inline constexpr std::uint32_t kAutomatic = 1u << 14;   // AOE
inline constexpr std::uint32_t kMainOutput = 1u << 15;  // MOE

}  // namespace timer
}  // namespace hoof::firmware::stm32f405
