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

namespace {

void take_frames(hal::bxcan::BxCanBus System::*bus, std::size_t fifo) {
  System& all = system();
  (all.*bus).on_receive_interrupt(fifo, all.clock.now_ns());
  all.work = true;
}

void note_sent(hal::bxcan::BxCanBus System::*bus) {
  System& all = system();
  (all.*bus).on_transmit_interrupt();
  all.room = true;
}

void note_status(hal::bxcan::BxCanBus System::*bus) {
  System& all = system();
  (all.*bus).on_status_interrupt();
  all.work = true;
  all.watch = true;
}

void serve(SerialLine System::*line, SerialBus System::*bus) {
  System& all = system();
  (all.*line).on_interrupt(all.*bus, all.clock.now_ns());
  all.work = true;
}

}  // namespace

extern "C" {
void hoof_tick() {
  System& all = system();
  all.clock.on_tick();
  all.work = true;
  all.watch = true;
}
void hoof_can1_transmit() {
  note_sent(&System::can0);
}
void hoof_can1_receive0() {
  take_frames(&System::can0, 0);
}
void hoof_can1_receive1() {
  take_frames(&System::can0, 1);
}
void hoof_can1_status() {
  note_status(&System::can0);
}
void hoof_timer1_break() {
  System& all = system();
  all.enable.on_break_interrupt();
  all.work = true;
}
void hoof_can2_transmit() {
  note_sent(&System::can1);
}
void hoof_can2_receive0() {
  take_frames(&System::can1, 0);
}
void hoof_can2_receive1() {
  take_frames(&System::can1, 1);
}
void hoof_can2_status() {
  note_status(&System::can1);
}
void hoof_usart1() {
  serve(&System::line0, &System::serial0);
}
void hoof_usart2() {
  serve(&System::line1, &System::serial1);
}
}

}  // namespace hoof::firmware::stm32f405
