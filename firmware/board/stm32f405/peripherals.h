// Where the peripherals are, and their interrupts.
//
// Sources: RM0090 rev. 19, 2.3 (memory map) and 12.2 (vectors); checked against the device header
// of ST's cmsis_device_f4 (stm32f405xx.h). Core: ARM DDI 0403E, B3.2.
#pragma once

#include <cstdint>

#include "firmware/board/stm32f405/registers/adc.h"
#include "firmware/board/stm32f405/registers/core.h"
#include "firmware/board/stm32f405/registers/flash.h"
#include "firmware/board/stm32f405/registers/gpio.h"
#include "firmware/board/stm32f405/registers/iwdg.h"
#include "firmware/board/stm32f405/registers/pwr.h"
#include "firmware/board/stm32f405/registers/rcc.h"
#include "firmware/board/stm32f405/registers/timer.h"
#include "firmware/board/stm32f405/registers/usart.h"
#include "hal/bxcan/registers.h"

namespace hoof::firmware::stm32f405 {

template <typename Block>
[[gnu::always_inline]] inline Block& at(std::uintptr_t address) {
  return *reinterpret_cast<Block*>(address);
}

inline const FactoryCalibration& factory_calibration() {
  return at<const FactoryCalibration>(0x1FFF'7A2A);
}
inline IwdgRegisters& iwdg_registers() {
  return at<IwdgRegisters>(0x4000'3000);
}
inline UsartRegisters& usart2_registers() {
  return at<UsartRegisters>(0x4000'4400);
}
inline hal::bxcan::Registers& can1_registers() {
  return at<hal::bxcan::Registers>(0x4000'6400);
}
inline hal::bxcan::Registers& can2_registers() {
  return at<hal::bxcan::Registers>(0x4000'6800);
}
inline PwrRegisters& pwr_registers() {
  return at<PwrRegisters>(0x4000'7000);
}
inline TimerRegisters& timer1_registers() {
  return at<TimerRegisters>(0x4001'0000);
}
inline UsartRegisters& usart1_registers() {
  return at<UsartRegisters>(0x4001'1000);
}
inline AdcRegisters& adc1_registers() {
  return at<AdcRegisters>(0x4001'2000);
}
inline AdcCommonRegisters& adc_common_registers() {
  return at<AdcCommonRegisters>(0x4001'2300);
}
inline GpioRegisters& port_a() {
  return at<GpioRegisters>(0x4002'0000);
}
inline GpioRegisters& port_b() {
  return at<GpioRegisters>(0x4002'0400);
}
inline GpioRegisters& port_c() {
  return at<GpioRegisters>(0x4002'0800);
}
inline RccRegisters& rcc_registers() {
  return at<RccRegisters>(0x4002'3800);
}
inline FlashRegisters& flash_registers() {
  return at<FlashRegisters>(0x4002'3C00);
}
inline SysTickRegisters& systick_registers() {
  return at<SysTickRegisters>(0xE000'E010);
}
inline NvicRegisters& nvic_registers() {
  return at<NvicRegisters>(0xE000'E100);
}
inline ScbRegisters& scb_registers() {
  return at<ScbRegisters>(0xE000'ED00);
}
inline MpuRegisters& mpu_registers() {
  return at<MpuRegisters>(0xE000'ED90);
}

/// Position in the vector table, from the first interrupt of the part.
enum class Interrupt : std::uint8_t {
  kCan1Transmit = 19,
  kCan1Receive0 = 20,
  kCan1Receive1 = 21,
  kCan1Status = 22,
  kTimer1Break = 24,
  kUsart1 = 37,
  kUsart2 = 38,
  kCan2Transmit = 63,
  kCan2Receive0 = 64,
  kCan2Receive1 = 65,
  kCan2Status = 66,
};

inline constexpr std::uint32_t kInterruptCount = 82;

}  // namespace hoof::firmware::stm32f405
