// Reset and clock control: clocks start some looks after they are switched on, or never.
//
// Source: RM0090 rev. 19, 7.3.
#pragma once

#include <cstdint>
#include <functional>

#include "hal/board.h"
#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

/// What is wrong with the clocks of this board.
struct ClockFaults {
  bool crystal_dead = false;
  bool pll_dead = false;
};

class Rcc final : public Peripheral {
 public:
  /// @param on_core_clock called with the core's clock in MHz when it changes
  explicit Rcc(std::function<void(std::uint32_t)> on_core_clock)
      : on_core_clock_(std::move(on_core_clock)) {}

  const char* name() const override { return "RCC"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  /// All but the cause of the reset.
  void reset() override;

  void note_reset(hal::ResetCause cause);
  void set_faults(const ClockFaults& faults) { faults_ = faults; }
  /// The running crystal fails: the clock security system switches it and its PLL off and the core
  /// to the internal oscillator. @return false where it is not on
  bool fail_crystal();

  std::uint32_t core_MHz() const { return core_MHz_; }
  std::uint32_t apb1_MHz() const;
  std::uint32_t apb2_MHz() const;
  /// Of the timers on APB2: twice its clock where that is divided.
  std::uint32_t timer2_MHz() const;
  bool ahb1_on(std::uint32_t bit) const { return (ahb1_ >> bit & 1) != 0; }
  bool apb1_on(std::uint32_t bit) const { return (apb1_ >> bit & 1) != 0; }
  bool apb2_on(std::uint32_t bit) const { return (apb2_ >> bit & 1) != 0; }
  bool from_crystal() const;

 private:
  std::uint32_t clock_control();
  void write_clock_control(std::uint32_t value);
  void switch_clock();
  std::uint32_t pll_MHz() const;

  std::function<void(std::uint32_t)> on_core_clock_;
  ClockFaults faults_;
  std::uint32_t control_ = 0;
  std::uint32_t pll_ = 0;
  std::uint32_t configuration_ = 0;
  std::uint32_t ahb1_ = 0, apb1_ = 0, apb2_ = 0;
  std::uint32_t status_ = 0;
  int crystal_looks_ = 0, pll_looks_ = 0;  // left until it is ready
  std::uint32_t core_MHz_ = 16;
};

}  // namespace hoof::tools::emulator
