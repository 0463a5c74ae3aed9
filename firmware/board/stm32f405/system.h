// The drivers of this board, each once.
#pragma once

#include "firmware/board/stm32f405/clock_tree.h"
#include "firmware/board/stm32f405/flash_memory.h"
#include "firmware/board/stm32f405/foot_board.h"
#include "firmware/board/stm32f405/system_clock.h"
#include "firmware/board/stm32f405/watchdog.h"
#include "hal/bxcan/bxcan_bus.h"

namespace hoof::firmware::stm32f405 {

struct System {
  Watchdog watchdog;
  SystemClock clock;
  FlashMemory flash;
  FootBoard board;
  hal::bxcan::BxCanBus bus0;  // CAN1
  hal::bxcan::BxCanBus bus1;  // CAN2

  /// Watchdog, clocks, pins, buses, interrupts, in this order. Every wait in it is bounded.
  void start();

  /// Once per turn of the main loop: buses joining and recovering, then sleep until an interrupt.
  /// Does not sleep while a frame waits.
  void rest();
};

System& system();

}  // namespace hoof::firmware::stm32f405
