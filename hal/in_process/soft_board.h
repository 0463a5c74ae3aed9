// The board of a program: nothing pressed, supply good, unless told otherwise.
#pragma once

#include <cstdint>
#include <limits>

#include "hal/board.h"

namespace hoof::hal {

/// Has no watchdog: a program that hangs is noticed by the drives, which drop their torque 20 ms
/// after the last command.
class SoftBoard final : public Board {
 public:
  ResetCause cause = ResetCause::kPowerOn;
  bool pressed = false;
  bool low = false;
  float volts = 0.0f;
  float celsius = std::numeric_limits<float>::quiet_NaN();
  bool drives_allowed = false;  // as the loop said last
  std::uint32_t feeds = 0;      // calls of feed_watchdog()

  ResetCause reset_cause() const override { return cause; }
  void feed_watchdog() override { ++feeds; }
  bool emergency_stop_pressed() const override { return pressed; }
  void allow_drives(bool allowed) override { drives_allowed = allowed; }
  bool supply_low() const override { return low; }
  float supply_V() const override { return volts; }
  float temperature_C() const override { return celsius; }
};

}  // namespace hoof::hal
