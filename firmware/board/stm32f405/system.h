// The drivers of this board, each once.
#pragma once

#include "firmware/board/stm32f405/clock_tree.h"
#include "firmware/board/stm32f405/flash_memory.h"
#include "firmware/board/stm32f405/foot_board.h"
#include "firmware/board/stm32f405/serial_line.h"
#include "firmware/board/stm32f405/system_clock.h"
#include "firmware/board/stm32f405/watchdog.h"
#include "hal/bxcan/bxcan_bus.h"
#include "hal/slcan/fallback_bus.h"

namespace hoof::firmware::stm32f405 {

using SerialBus = hal::slcan::SlcanBus<SerialLine>;
using FootBus = hal::FallbackBus<hal::bxcan::BxCanBus, SerialBus>;

struct System {
  Watchdog watchdog;
  SystemClock clock;
  FlashMemory flash;
  FootBoard board;
  hal::bxcan::BxCanBus can0;  // CAN1
  hal::bxcan::BxCanBus can1;  // CAN2
  SerialLine line0;           // USART1
  SerialLine line1;           // USART2
  SerialBus serial0;
  SerialBus serial1;
  hal::SerialGate gate;
  FootBus bus0;  // can0, or serial0 until someone speaks on CAN
  FootBus bus1;  // can1, or serial1

  /// Watchdog, clocks, pins, buses, interrupts, in this order. Every wait in it is bounded.
  void start();

  /// Once per turn of the main loop: buses joining and recovering, then sleep until there is work:
  /// a frame has come, a millisecond has passed, a bus has changed its state.
  /// @param for_room work is also that a frame was sent: another waits for its place
  void rest(bool for_room);

  /// What the interrupts tell the main loop.
  volatile bool work = true;   // there is some, since rest() returned
  volatile bool room = false;  // a frame was sent, since rest() returned
  volatile bool watch = true;  // the buses are to be looked after
};

System& system();

}  // namespace hoof::firmware::stm32f405
