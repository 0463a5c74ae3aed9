// Independent watchdog: resets the board when it is not fed.
#pragma once

#include <cstdint>

#include "firmware/board/stm32f405/registers/iwdg.h"

namespace hoof::firmware::stm32f405 {

/// Runs on an RC oscillator of its own, of 17 to 47 kHz (DS8626, LSI
/// characteristics): each time is a range.
/// Once started nothing but a reset stops it.
class Watchdog {
 public:
  enum class Time : std::uint8_t {
    kTick,   // 20 to 55 ms: a control cycle was not finished
    kStart,  // 1 to 2.8 s: for the start, and for erasing a sector of data (0.5 s at most)
  };

  explicit Watchdog(IwdgRegisters& registers) : registers_(registers) {}

  void start(Time time) {
    registers_.KR.write(iwdg::kStart);
    set(time);
  }

  /// Also feeds it.
  void set(Time time);

  Time time() const { return time_; }

  /// Also from code that runs in RAM.
  [[gnu::always_inline]] void feed() { registers_.KR.write(iwdg::kReload); }

 private:
  IwdgRegisters& registers_;
  Time time_ = Time::kStart;
};

}  // namespace hoof::firmware::stm32f405
