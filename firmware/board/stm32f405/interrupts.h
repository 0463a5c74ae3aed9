// The interrupts that are served.
#pragma once

#include "firmware/board/stm32f405/peripherals.h"

namespace hoof::firmware::stm32f405 {

/// Lets the interrupts in. All have one priority: none interrupts another, so that the stack holds
/// one at a time, and the clock may be read in each.
void enable_interrupts(NvicRegisters& nvic, ScbRegisters& scb);

extern "C" {
void hoof_tick();
void hoof_can1_transmit();
void hoof_can1_receive0();
void hoof_can1_receive1();
void hoof_can1_status();
void hoof_timer1_break();
void hoof_can2_transmit();
void hoof_can2_receive0();
void hoof_can2_receive1();
void hoof_can2_status();
void hoof_usart1();
void hoof_usart2();
}

}  // namespace hoof::firmware::stm32f405
