// This board as hal::Board.
#pragma once

#include <cstdint>

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
  FootBoard(RccRegisters& rcc, PwrRegisters& pwr, const GpioRegisters& port, Watchdog& watchdog)
      : rcc_(rcc), pwr_(pwr), port_(port), watchdog_(watchdog) {}

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

  hal::ResetCause reset_cause() const override { return reset_cause_; }
  void feed_watchdog() override { watchdog_.feed(); }

  /// The button's loop feeds 3.3 V to a pin that is pulled down: open, cut or shorted to ground it
  /// reads low.
  bool emergency_stop_pressed() const override { return !port_.IDR.has(kEmergencyStopPin.bit()); }

  /// Below 2.9 V; at 2.7 V flash can no longer be programmed.
  bool supply_low() const override { return pwr_.CSR.has(pwr::kSupplyBelow); }

  /// Not measured.
  float supply_V() const override { return 0.0f; }

 private:
  RccRegisters& rcc_;
  PwrRegisters& pwr_;
  const GpioRegisters& port_;
  Watchdog& watchdog_;
  hal::ResetCause reset_cause_ = hal::ResetCause::kPowerOn;
};

}  // namespace hoof::firmware::stm32f405
