// What the firmware needs of the board it runs on, apart from buses, clock and flash.
#pragma once

#include <cstdint>

namespace hoof::hal {

/// Why the board started.
enum class ResetCause : std::uint8_t {
  kPowerOn = 0,
  kPin,        // the reset button, or a debugger
  kSoftware,   // asked for by the firmware itself, the fault handlers included
  kWatchdog,   // a control cycle did not finish in time
  kBrownOut,   // the supply fell below the level at which the core stops
  kRequested,  // asked for by a word that it obeyed: the start of a new image
};

/// One board. None of these calls waits.
class Board {
 public:
  /// Why it started; the same for as long as it runs.
  virtual ResetCause reset_cause() const = 0;

  /// Restarts the time after which the watchdog resets the board. To be called after a finished
  /// control cycle and from nowhere else.
  virtual void feed_watchdog() = 0;

  /// The e-stop line: true while the loop of the button is open. A cut wire reads as pressed. Where
  /// hardware catches a press too short to be asked for, true until allow_drives(false).
  virtual bool emergency_stop_pressed() const = 0;

  /// Once at the end of each turn of the loop: whether the drives may have torque, for boards with
  /// a line of their own to the drives. A pressed e-stop takes it away on its own and before.
  virtual void allow_drives(bool allowed) = 0;

  /// True once the supply has fallen below the early-warning level; milliseconds are left.
  virtual bool supply_low() const = 0;

  /// Supply of board and drives; 0 where it is not measured.
  virtual float supply_V() const = 0;

  /// Of the processor; not a number where it is not measured.
  virtual float temperature_C() const = 0;

 protected:
  ~Board() = default;
};

}  // namespace hoof::hal
