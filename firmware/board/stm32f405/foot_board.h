// This board as hal::Board.
#pragma once

#include <cstdint>

#include "firmware/board/stm32f405/board_meter.h"
#include "firmware/board/stm32f405/drive_enable.h"
#include "firmware/board/stm32f405/pins.h"
#include "firmware/board/stm32f405/registers/gpio.h"
#include "firmware/board/stm32f405/registers/pwr.h"
#include "firmware/board/stm32f405/registers/rcc.h"
#include "firmware/board/stm32f405/watchdog.h"
#include "hal/board.h"

namespace hoof::firmware::stm32f405 {

/// What RCC_CSR says. Each reset also pulls the reset pin, and switching on also counts as a
/// brown-out, so the first that fits in this order is the cause.
constexpr hal::ResetCause reset_cause_of(std::uint32_t csr) {
  if ((csr & rcc::kPowerOnReset) != 0) return hal::ResetCause::kPowerOn;
  if ((csr & rcc::kBrownOutReset) != 0) return hal::ResetCause::kBrownOut;
  if ((csr & (rcc::kIndependentWatchdogReset | rcc::kWindowWatchdogReset)) != 0) {
    return hal::ResetCause::kWatchdog;
  }
  // This firmware never asks for low power: such a reset is a defect of the software, too.
  if ((csr & (rcc::kSoftwareReset | rcc::kLowPowerReset)) != 0) return hal::ResetCause::kSoftware;
  if ((csr & rcc::kPinReset) != 0) return hal::ResetCause::kPin;
  return hal::ResetCause::kPowerOn;
}

class FootBoard final : public hal::Board {
 public:
  /// Turns of the main loop, some six a millisecond, after which a clock that has not moved is
  /// dead.
  static constexpr std::uint32_t kMostTurns = 100;

  FootBoard(RccRegisters& rcc, PwrRegisters& pwr, const GpioRegisters& port, Watchdog& watchdog,
            const BoardMeter& meter, DriveEnable& enable)
      : rcc_(rcc), pwr_(pwr), port_(port), watchdog_(watchdog), meter_(meter), enable_(enable) {}

  /// Before anything else resets: takes the cause and clears it, switches on the supply's watch.
  /// @param requested whether a reset by software was the firmware's own will and no crash
  /// @pre the power interface has its clock
  void start(bool requested = false) {
    reset_cause_ = reset_cause_of(rcc_.CSR.read());
    if (requested && reset_cause_ == hal::ResetCause::kSoftware) {
      reset_cause_ = hal::ResetCause::kRequested;
    }
    rcc_.CSR.set(rcc::kClearResetFlags);
    pwr_.CR.set(pwr::kDetector2V9 | pwr::kDetectorOn);
  }

  /// Once per turn of the main loop. Every time-out of this firmware needs a clock that goes on: on
  /// one that stands, SYNC alone would keep the loop, and the watchdog, going.
  /// @param stamp of the clock
  void note_time(std::uint32_t stamp) {
    turns_ = stamp == stamp_ ? turns_ + 1 : 0;
    stamp_ = stamp;
  }

  hal::ResetCause reset_cause() const override { return reset_cause_; }
  void feed_watchdog() override {
    if (turns_ < kMostTurns) watchdog_.feed();
  }

  /// The button's loop feeds 3.3 V to a pin that is pulled down: open, cut or shorted to ground it
  /// reads low. What was too short to be read has left the timer's break flag.
  bool emergency_stop_pressed() const override {
    return !port_.IDR.has(kEmergencyStopPin.bit()) || enable_.broken();
  }

  void allow_drives(bool allowed) override { enable_.allow(allowed); }

  /// Below 2.9 V; at 2.7 V flash can no longer be programmed.
  bool supply_low() const override { return pwr_.CSR.has(pwr::kSupplyBelow); }

  float supply_V() const override { return meter_.supply_V(); }
  float temperature_C() const override { return meter_.temperature_C(); }

 private:
  RccRegisters& rcc_;
  PwrRegisters& pwr_;
  const GpioRegisters& port_;
  Watchdog& watchdog_;
  const BoardMeter& meter_;
  DriveEnable& enable_;
  hal::ResetCause reset_cause_ = hal::ResetCause::kPowerOn;
  std::uint32_t stamp_ = 0;
  std::uint32_t turns_ = 0;  // since the clock moved
};

}  // namespace hoof::firmware::stm32f405
