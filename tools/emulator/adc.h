// The first analog-to-digital converter, with the voltages that are at its channels.
//
// Sources: RM0090 rev. 19, 13.3 (injected group, timing) and 13.13; DS8626 (temperature sensor,
// internal reference, their calibration values). Only the injected group, started by software,
// without interrupts, has a model.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

/// What there is to measure.
struct BoardVoltages {
  double supply_V = 0;  // of board and drives; 0: nothing is wired, the pin is at ground
  double temperature_C = 25;
  double analog_V = 3.3;  // the board's own supply, to which the converter compares
};

class Adc final : public Peripheral {
 public:
  /// What the factory measured on this part at 3.3 V, at 30 and 110 C, and wrote at 0x1FFF7A2A:
  /// reference, sensor at 30 C, sensor at 110 C.
  static constexpr std::uint32_t kFactoryAddress = 0x1FFF'7A2A;
  static std::array<std::uint16_t, 3> factory_calibration();

  /// @param clock_MHz of the peripheral now  @param analog whether the pin of a channel is analog
  Adc(const BoardTime& time, std::function<std::uint32_t()> clock_MHz,
      std::function<bool(std::uint32_t channel)> analog)
      : time_(time), clock_MHz_(std::move(clock_MHz)), analog_(std::move(analog)) {}

  const char* name() const override { return "ADC1"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  void set_voltages(const BoardVoltages& voltages);
  const BoardVoltages& voltages() const { return at_; }
  /// It begins conversions and ends none.
  void set_dead(bool dead) { dead_ = dead; }

 private:
  std::uint32_t conversions() const { return (sequence_ >> 20 & 3) + 1; }
  std::uint32_t channel(std::uint32_t conversion) const;
  std::uint32_t counts_of(std::uint32_t channel) const;
  Cycles duration() const;
  void convert();
  void start_injected();

  const BoardTime& time_;
  std::function<std::uint32_t()> clock_MHz_;
  std::function<bool(std::uint32_t)> analog_;
  BoardVoltages at_;
  bool dead_ = false;
  std::uint32_t status_ = 0, control1_ = 0, control2_ = 0, sequence_ = 0, common_ = 0;
  std::array<std::uint32_t, 2> sampling_{};
  std::array<std::uint32_t, 4> data_{};
  bool converting_ = false;
  Cycles on_since_ = 0, ready_ = 0;
};

}  // namespace hoof::tools::emulator
