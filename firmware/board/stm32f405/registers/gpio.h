// One port of pins.
//
// Sources: RM0090 rev. 19, 8.4; checked against the device header of ST's cmsis_device_f4
// (stm32f405xx.h, GPIO_TypeDef). Alternate functions: DS8626, table 9.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct GpioRegisters {
  hal::Register MODER;  // 2 bits a pin: 0 input, 1 output, 2 alternate function, 3 analog
  hal::Register OTYPER;
  hal::Register OSPEEDR;  // 2 bits a pin
  hal::Register PUPDR;    // 2 bits a pin: 1 pull-up, 2 pull-down
  hal::Register IDR;
  hal::Register ODR;
  hal::Register BSRR;
  hal::Register LCKR;
  std::array<hal::Register, 2> AFR;  // 4 bits a pin
};

static_assert(offsetof(GpioRegisters, IDR) == 0x10 && offsetof(GpioRegisters, AFR) == 0x20);

}  // namespace hoof::firmware::stm32f405
