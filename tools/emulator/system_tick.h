// SysTick: counts down with the core's clock, from the board's time and not step by step.
//
// Source: ARM DDI 0403E, B3.3.
#pragma once

#include <cstdint>

#include "tools/emulator/nvic.h"
#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class SystemTick final : public Peripheral {
 public:
  static constexpr Cycles kNever = INT64_MAX;

  SystemTick(const BoardTime& time, Nvic& nvic) : time_(time), nvic_(nvic) {}

  // Registers from 0xE000E010 on.
  const char* name() const override { return "SysTick"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  /// Raises what the time since the last call brought: one tick at most is pending.
  void advance();
  /// When the counter reaches zero next.
  Cycles next_tick() const { return running() && !stuck_ ? next_ : kNever; }
  /// It stands: no tick comes, and the counter reads what it is at.
  void set_stuck(bool stuck);
  /// Of the clock that it counts.
  void set_core_MHz(std::uint32_t megahertz);

 private:
  bool running() const { return (control_ & 1) != 0; }
  Cycles now() const { return stuck_ ? stuck_at_ : time_.now; }
  Cycles period() const { return core_to_board(Cycles(reload_) + 1); }
  Cycles core_to_board(Cycles cycles) const { return cycles * 168 / core_MHz_; }
  void start();

  const BoardTime& time_;
  Nvic& nvic_;
  std::uint32_t control_ = 0;
  std::uint32_t reload_ = 0;
  bool passed_zero_ = false;  // COUNTFLAG
  Cycles next_ = kNever;      // when it reaches zero
  std::uint32_t core_MHz_ = 16;
  bool stuck_ = false;
  Cycles stuck_at_ = 0;
};

}  // namespace hoof::tools::emulator
