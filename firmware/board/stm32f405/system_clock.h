// Time since start, from SysTick.
#pragma once

#include <cstdint>

#include "firmware/board/stm32f405/registers/core.h"
#include "hal/clock.h"

namespace hoof::firmware::stm32f405 {

/// Counts milliseconds by interrupt and reads the rest from the counter. May be read from the main
/// loop and from interrupts of the tick's own priority.
class SystemClock final : public hal::Clock {
 public:
  /// @param first_ms where counting begins: zero but in tests of what happens after 49 days
  SystemClock(SysTickRegisters& systick, ScbRegisters& scb, std::uint64_t first_ms = 0)
      : systick_(systick),
        scb_(scb),
        low_(static_cast<std::uint32_t>(first_ms)),
        high_(static_cast<std::uint32_t>(first_ms >> 32)) {}

  /// From here on time passes. @param core_Hz whole megahertz
  void start(std::uint32_t core_Hz) {
    cycles_per_us_ = core_Hz / 1'000'000;
    reload_ = core_Hz / 1'000 - 1;
    systick_.RVR.write(reload_);
    systick_.CVR.write(0);
    systick_.CSR.write(systick::kRun);
  }

  [[gnu::always_inline]] void on_tick() {
    low_ = low_ + 1;
    if (low_ == 0) high_ = high_ + 1;
  }

  /// For a wait with interrupts masked: does the interrupt's work where it is due.
  /// @return whether a millisecond has passed since the last call
  [[gnu::always_inline]] bool take_pending_tick() {
    if (!scb_.ICSR.has(scb::kPendingTick)) return false;
    scb_.ICSR.write(scb::kClearPendingTick);
    on_tick();
    return true;
  }

  std::int64_t now_ns() const override;

  /// Another value whenever a cycle of the core has gone by, for 256 ms; the same while the counter
  /// stands. Costs a few instructions, now_ns() some fifty.
  std::uint32_t stamp() const { return (low_ << 24) | systick_.CVR.read(); }

 private:
  SysTickRegisters& systick_;
  ScbRegisters& scb_;
  std::uint32_t cycles_per_us_ = 1;
  std::uint32_t reload_ = 0;
  // Milliseconds; in two words, as the interrupt cannot change more at a time.
  volatile std::uint32_t low_;
  volatile std::uint32_t high_;
};

}  // namespace hoof::firmware::stm32f405
