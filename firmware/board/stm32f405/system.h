// The drivers of this board, each once.
#pragma once

#include "firmware/board/stm32f405/board_meter.h"
#include "firmware/board/stm32f405/clock_tree.h"
#include "firmware/board/stm32f405/drive_enable.h"
#include "firmware/board/stm32f405/flash_memory.h"
#include "firmware/board/stm32f405/foot_board.h"
#include "firmware/board/stm32f405/lock_step_board.h"
#include "firmware/board/stm32f405/serial_line.h"
#include "firmware/board/stm32f405/system_clock.h"
#include "firmware/board/stm32f405/watchdog.h"
#include "hal/bxcan/bxcan_bus.h"
#include "hal/image_slots.h"
#include "hal/slcan/fallback_bus.h"

namespace hoof::firmware::stm32f405 {

using FootBus = hal::FallbackBus<hal::bxcan::BxCanBus, SerialBus>;

/// The slots of this part, of which this image is in one.
class Slots final : public hal::ImageSlots {
 public:
  explicit Slots(FlashMemory& flash) : flash_(flash) {}
  hal::Nonvolatile& flash() override { return flash_; }
  std::size_t running() const override;
  void restart() override;

 private:
  FlashMemory& flash_;
};

struct System {
  Watchdog watchdog;
  SystemClock clock;
  FlashMemory flash;
  FlashMemory images;
  Slots slots;
  BoardMeter meter;    // ADC1
  DriveEnable enable;  // TIM1
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

  /// As lock_step_board.h has it. After start().
  bool only_core_and_lines() const;

  /// Once per turn of the main loop: buses joining and recovering, the next measurement, then sleep
  /// until there is work: a frame has come, a millisecond has passed, a bus or the e-stop has
  /// changed its state.
  /// @param for_room work is also that a frame was sent: another waits for its place
  void rest(bool for_room);
  /// The same where nothing but the lines can bring anything.
  void rest_by_lines();

  /// What the interrupts tell the main loop.
  volatile bool work = true;   // there is some, since rest() returned
  volatile bool room = false;  // a frame was sent, since rest() returned
  volatile bool watch = true;  // buses and measurement are to be looked after
};

System& system();

}  // namespace hoof::firmware::stm32f405
