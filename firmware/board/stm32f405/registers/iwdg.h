// Independent watchdog.
//
// Sources: RM0090 rev. 19, 21.4; checked against the device header of ST's cmsis_device_f4
// (stm32f405xx.h, IWDG_TypeDef and the bits IWDG_*).
#pragma once

#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct IwdgRegisters {
  hal::Register KR;
  hal::Register PR;
  hal::Register RLR;
  hal::Register SR;
};

namespace iwdg {
inline constexpr std::uint32_t kReload = 0xAAAA;
inline constexpr std::uint32_t kUnlock = 0x5555;
inline constexpr std::uint32_t kStart = 0xCCCC;
inline constexpr std::uint32_t kLargestReload = 0xFFF;
inline constexpr std::uint32_t kUpdating = 3u;  // SR: PVU, RVU
}  // namespace iwdg
}  // namespace hoof::firmware::stm32f405
