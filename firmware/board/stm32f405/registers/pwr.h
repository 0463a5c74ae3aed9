// Power control.
//
// Sources: RM0090 rev. 19, 5.4; checked against the device header of ST's cmsis_device_f4
// (stm32f405xx.h, PWR_TypeDef and the bits PWR_*).
#pragma once

#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct PwrRegisters {
  hal::Register CR;
  hal::Register CSR;
};

namespace pwr {
inline constexpr std::uint32_t kDetectorOn = 1u << 4;    // CR PVDE
inline constexpr std::uint32_t kDetector2V9 = 7u << 5;   // CR PLS, the highest level
inline constexpr std::uint32_t kFullVoltage = 1u << 14;  // CR VOS: needed above 144 MHz
inline constexpr std::uint32_t kSupplyBelow = 1u << 2;   // CSR PVDO
}  // namespace pwr
}  // namespace hoof::firmware::stm32f405
