#include "firmware/board/stm32f405/system.h"

#include "firmware/board/stm32f405/can_filters.h"
#include "firmware/board/stm32f405/crash.h"
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
    FlashMemory(flash_registers(), reinterpret_cast<hal::Register*>(kImages), the_system.watchdog,
                the_system.clock, FlashMemory::kImages),
    Slots(the_system.images),
    BoardMeter(adc1_registers(), adc_common_registers(), factory_calibration()),
    DriveEnable(timer1_registers()),
    FootBoard(rcc_registers(), pwr_registers(), port_b(), the_system.watchdog, the_system.meter,
              the_system.enable),
    BxCanBus(can1_registers()),
    BxCanBus(can2_registers()),
    SerialLine(usart1_registers()),
    SerialLine(usart2_registers()),
    SerialBus(the_system.line0),
    SerialBus(the_system.line1),
    {},
    FootBus(the_system.can0, the_system.serial0, the_system.gate),
    FootBus(the_system.can1, the_system.serial1, the_system.gate),
};

}  // namespace

std::size_t Slots::running() const {
  return running_slot();
}

void Slots::restart() {
  restart_on_request();
}

System& system() {
  return the_system;
}

void System::start() {
  watchdog.start(Watchdog::Time::kStart);
  const Clocks clocks = start_clocks(rcc_registers(), pwr_registers(), flash_registers());
  board.start(take_restart_request());
  clock.start(clocks.core_Hz);
  rcc_registers().AHB1ENR.set(rcc::kPortA | rcc::kPortB | rcc::kPortC);
  rcc_registers().APB1ENR.set(rcc::kCan1 | rcc::kCan2 | rcc::kUsart2);
  rcc_registers().APB2ENR.set(rcc::kTimer1 | rcc::kUsart1 | rcc::kAdc1);
  rcc_registers().APB2ENR.read();  // a peripheral answers some cycles later (ES0182)
  configure_pins(port_a(), port_b(), port_c());
  // TIM1's clock is the core's: APB2's, twice where that is divided (RM0090, 7.2).
  enable.start(clocks.core_Hz);
  meter.start();
  set_can_filters(can1_registers());
  if (const std::optional<std::uint32_t> timing = can_bit_timing(clocks)) {
    can0.start(*timing);
    can1.start(*timing);
  }
  line0.start(clocks.apb2_Hz);
  line1.start(clocks.apb1_Hz);
  enable_interrupts(nvic_registers(), scb_registers());
}

void System::rest(bool for_room) {
  board.note_time(clock.stamp());
  if (watch) {
    watch = false;
    const std::int64_t now_ns = clock.now_ns();
    can0.maintain(now_ns);
    can1.maintain(now_ns);
    meter.maintain(now_ns);
  }
  for (;;) {
    // With interrupts masked: one that came between looking and sleeping would else be slept over.
    // WFI wakes up all the same, and the interrupt runs at the end of the turn.
    const hal::InterruptLock lock;
    if (work || (for_room && room)) {
      work = false;
      room = false;
      return;
    }
    asm volatile("dsb\n\twfi" ::: "memory");
  }
}

bool System::only_core_and_lines() const {
  return stm32f405::only_core_and_lines(rcc_registers(), port_a(), port_b(), can1_registers());
}

void System::rest_by_lines() {
  const hal::InterruptLock lock;
  const bool waiting = serial0.frame_waiting() || !line0.all_sent() || !line1.all_sent();
  if (!waiting) asm volatile("dsb\n\twfi" ::: "memory");
}

}  // namespace hoof::firmware::stm32f405
