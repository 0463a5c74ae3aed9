// The line that lets the drives have torque, and the break input that takes it away.
#pragma once

#include <cstdint>

#include "firmware/board/stm32f405/registers/timer.h"

namespace hoof::firmware::stm32f405 {

/// A square wave on TIM1's channel 1, as a charge pump takes it: a line that is stuck at either
/// level, by a dead clock or a short, enables nothing. The e-stop's loop is TIM1's break input.
/// Once it opens, and where the clock security system finds the crystal dead, the timer drives the
/// line low, without an instruction and without a clock, and leaves it low until allow(true).
class DriveEnable {
 public:
  static constexpr std::uint32_t kWave_Hz = 12'500;  // what the charge pumps of CNC boards expect

  explicit DriveEnable(TimerRegisters& timer) : timer_(timer) {}

  /// The line stays low. Then all but the output's own switch is locked until the next reset: a
  /// program gone wild cannot turn the break off.
  /// @param timer_Hz its clock, whole megahertz  @pre it has that clock, and the pins are set
  void start(std::uint32_t timer_Hz);

  /// True from a break on, however short, until allow(false) finds the loop closed again.
  bool broken() const { return timer_.SR.has(timer::kBreak); }

  /// Does not override a break that nobody has seen yet: only allow(false) forgets it.
  void allow(bool allowed);

  /// The flag stays, and it would interrupt for as long as the loop is open.
  void on_break_interrupt() { timer_.DIER.clear(timer::kBreak); }

 private:
  TimerRegisters& timer_;
  bool on_ = false;  // as asked for; a break may have taken it away since
};

}  // namespace hoof::firmware::stm32f405
