#include "firmware/board/stm32f405/interrupts.h"

#include "firmware/board/stm32f405/system.h"

namespace hoof::firmware::stm32f405 {
namespace {

constexpr std::uint32_t kPriority = 0x40;

void enable(NvicRegisters& nvic, Interrupt interrupt) {
  const auto number = static_cast<std::uint32_t>(interrupt);
  const std::uint32_t shift = 8 * (number % 4);
  nvic.IPR[number / 4].change(0xFFu << shift, kPriority << shift);
  nvic.ISER[number / 32].write(1u << (number % 32));
}

}  // namespace

void enable_interrupts(NvicRegisters& nvic, ScbRegisters& scb) {
  scb.SHPR[2].change(0xFFu << 24, kPriority << 24);  // SysTick
  for (const Interrupt interrupt :
       {Interrupt::kCan1Transmit, Interrupt::kCan1Receive0, Interrupt::kCan1Receive1,
        Interrupt::kCan1Status, Interrupt::kTimer1Break, Interrupt::kCan2Transmit,
        Interrupt::kCan2Receive0, Interrupt::kCan2Receive1, Interrupt::kCan2Status,
        Interrupt::kUsart1, Interrupt::kUsart2}) {
    enable(nvic, interrupt);
  }
  asm volatile("cpsie i" ::: "memory");
}

extern "C" {
void hoof_tick() {
  system().clock.on_tick();
}
void hoof_can1_transmit() {
  system().can0.on_transmit_interrupt();
}
void hoof_can1_receive0() {
  system().can0.on_receive_interrupt(0, system().clock.now_ns());
}
void hoof_can1_receive1() {
  system().can0.on_receive_interrupt(1, system().clock.now_ns());
}
void hoof_can1_status() {
  system().can0.on_status_interrupt();
}
void hoof_timer1_break() {
  system().enable.on_break_interrupt();
}
void hoof_can2_transmit() {
  system().can1.on_transmit_interrupt();
}
void hoof_can2_receive0() {
  system().can1.on_receive_interrupt(0, system().clock.now_ns());
}
void hoof_can2_receive1() {
  system().can1.on_receive_interrupt(1, system().clock.now_ns());
}
void hoof_can2_status() {
  system().can1.on_status_interrupt();
}
void hoof_usart1() {
  system().line0.on_interrupt(system().serial0, system().clock.now_ns());
}
void hoof_usart2() {
  system().line1.on_interrupt(system().serial1, system().clock.now_ns());
}
}

}  // namespace hoof::firmware::stm32f405
