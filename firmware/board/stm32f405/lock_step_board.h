// What the control loop stands on in an emulator that has of this part the core and the serial
// lines and nothing else (QEMU's netduinoplus2): time, both buses and the e-stop's line are what a
// simulator at the other end of the lines says (hal/lock_step_frame.h).
//
// Not for a foot. Which board the loop gets is decided once, before it exists, and here it gets no
// CAN bus: no drive can hear it (README.md, "An emulator without CAN").
#pragma once

#include <array>
#include <limits>

#include "firmware/app/control_loop.h"
#include "firmware/board/stepped_connection.h"
#include "firmware/board/stm32f405/registers/gpio.h"
#include "firmware/board/stm32f405/registers/rcc.h"
#include "firmware/board/stm32f405/serial_line.h"
#include "hal/board.h"
#include "hal/bxcan/registers.h"
#include "hal/lock_step_frame.h"
#include "hal/slcan/slcan_bus.h"
#include "hal/stepped_clock.h"

namespace hoof::firmware::stm32f405 {

using SerialBus = hal::slcan::SlcanBus<SerialLine>;

/// True where none of these peripherals exists: each of the registers reads zero, which none does
/// on the part. A core that runs has a clock, and RCC_CR says which one is ready (RM0090, 7.3.1);
/// the ports have pins of alternate functions (8.4.1), without which no byte would come by a serial
/// line either; CAN sleeps after reset (32.9.2).
/// @pre clocks of the peripherals on, pins configured
bool only_core_and_lines(const RccRegisters& rcc, const GpioRegisters& port_a,
                         const GpioRegisters& port_b, const hal::bxcan::Registers& can);

class LockStepBoard final : public hal::Board {
 public:
  LockStepBoard(SerialLine& line0, SerialBus& serial0, SerialLine& line1, SerialBus& serial1)
      : lines_{&line0, &line1},
        serial_{&serial0, &serial1},
        buses_{Connection(serial0), Connection(serial1)} {}

  const hal::Clock& clock() const { return clock_; }
  app::ControlLoop::Buses buses() { return {&buses_[0], &buses_[1]}; }

  enum class Word : std::uint8_t {
    kNone,   // nothing to do
    kBegin,  // to be answered
    kGo,     // time has come to what it says: the loop must be polled, once, and then answered
  };
  /// The simulator's next word, if it has come. To be called whenever a byte may have.
  Word next_word();
  /// @param due_ns when the loop must be polled next without any frame
  void answer(std::int64_t due_ns);

  // Nothing of these is there.
  hal::ResetCause reset_cause() const override { return hal::ResetCause::kPowerOn; }
  void feed_watchdog() override {}
  bool emergency_stop_pressed() const override { return false; }
  void allow_drives(bool) override {}
  bool supply_low() const override { return false; }
  float supply_V() const override { return 0.0f; }
  float temperature_C() const override { return std::numeric_limits<float>::quiet_NaN(); }

 private:
  using Connection = board::SteppedConnection<SerialBus, SerialBus::kQueue>;

  Word take(const hal::CanFrame& frame);
  Word obey(const hal::lock_step::Go& go);
  void send_all();

  std::array<SerialLine*, protocol::kBusCount> lines_;
  std::array<SerialBus*, protocol::kBusCount> serial_;
  std::array<Connection, protocol::kBusCount> buses_;
  hal::SteppedClock clock_;
  bool begun_ = false;
  bool asked_ = false;  // the last word is to be answered
};

}  // namespace hoof::firmware::stm32f405
