#include "firmware/board/stm32f405/system.h"

#include "firmware/board/stm32f405/can_filters.h"
#include "firmware/board/stm32f405/interrupts.h"
#include "firmware/board/stm32f405/memory.h"
#include "firmware/board/stm32f405/peripherals.h"
#include "firmware/board/stm32f405/pins.h"
#include "hal/interrupt_lock.h"

namespace hoof::firmware::stm32f405 {
namespace {

using hal::bxcan::BxCanBus;

System the_system{
    Watchdog(iwdg_registers()),
    SystemClock(systick_registers(), scb_registers()),
    FlashMemory(flash_registers(), reinterpret_cast<hal::Register*>(kParameters),
                the_system.watchdog, the_system.clock),
    FootBoard(rcc_registers(), pwr_registers(), port_b(), the_system.watchdog),
    BxCanBus(can1_registers()),
    BxCanBus(can2_registers()),
};

}  // namespace

System& system() {
  return the_system;
}

void System::start() {
  watchdog.start(Watchdog::Time::kStart);
  const Clocks clocks = start_clocks(rcc_registers(), pwr_registers(), flash_registers());
  board.start();
  clock.start(clocks.core_Hz);
  rcc_registers().AHB1ENR.set(rcc::kPortB);
  rcc_registers().APB1ENR.set(rcc::kCan1 | rcc::kCan2);
  rcc_registers().APB1ENR.read();  // a peripheral answers some cycles later (ES0182)
  configure_pins(port_b());
  set_can_filters(can1_registers());
  if (const std::optional<std::uint32_t> timing = can_bit_timing(clocks)) {
    bus0.start(*timing);
    bus1.start(*timing);
  }
  enable_interrupts(nvic_registers(), scb_registers());
}

void System::rest() {
  const std::int64_t now_ns = clock.now_ns();
  bus0.maintain(now_ns);
  bus1.maintain(now_ns);
  // With interrupts masked: one that came between looking and sleeping would else be slept over.
  // WFI wakes up all the same.
  const hal::InterruptLock lock;
  if (!bus0.frame_waiting() && !bus1.frame_waiting()) asm volatile("dsb\n\twfi" ::: "memory");
}

}  // namespace hoof::firmware::stm32f405
