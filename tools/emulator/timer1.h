// Advanced-control timer 1: a square wave on channel 1, and the break that takes it away.
//
// Source: RM0090 rev. 19, 17.3.12 (break) and 17.4. Counting up in PWM mode 1 on channel 1 has a
// model, and nothing else. The break acts as in the part on the level of its input, at once and not
// by the core: MOE falls, BIF rises and cannot be cleared while it lasts.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "tools/emulator/nvic.h"
#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class Timer1 final : public Peripheral {
 public:
  static constexpr int kBreakInterrupt = 24;

  /// @param break_level of the input; called when somebody asks, and on_input() tells of changes
  /// @param clock_MHz of the timer now
  Timer1(Nvic& nvic, std::function<bool()> break_level, std::function<std::uint32_t()> clock_MHz)
      : nvic_(nvic), break_level_(std::move(break_level)), clock_MHz_(std::move(clock_MHz)) {}

  const char* name() const override { return "TIM1"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  /// The level of the input may have changed.
  void on_input();
  /// The clock security system's event: a break of its own.
  void on_clock_failure() { note_break(); }

  /// Of the wave on channel 1; 0 while it is off, and the pin low.
  double wave_Hz() const;

 private:
  std::uint32_t& plain(std::uint32_t offset);
  bool break_on() const;
  bool break_active() const;
  void note_break();
  void write_output_control(std::uint32_t value);
  void update_line();

  Nvic& nvic_;
  std::function<bool()> break_level_;
  std::function<std::uint32_t()> clock_MHz_;
  std::uint32_t control_ = 0, interrupts_ = 0, status_ = 0, mode_ = 0, outputs_ = 0;
  std::uint32_t prescaler_ = 0, reload_ = 0xFFFF, compare_ = 0, output_control_ = 0;
  std::uint32_t prescaler_used_ = 0;
  bool output_control_written_ = false;  // LOCK can be written once
};

}  // namespace hoof::tools::emulator
