// Supply and temperature, by the analog-to-digital converter.
#pragma once

#include <cstdint>
#include <limits>

#include "firmware/board/stm32f405/registers/adc.h"

namespace hoof::firmware::stm32f405 {

/// About once a millisecond three conversions in a row, which run while the core does something
/// else: supply, internal reference, temperature. The reference takes the board's own 3.3 V out of
/// the reckoning.
class BoardMeter {
 public:
  /// Supply over pin: 180 kOhm above 10 kOhm. At 3.3 V of the board it measures up to 62.7 V; 100
  /// nF beside the lower resistor make 0.95 ms of the motors' ripple.
  static constexpr float kDivider = (180.0f + 10.0f) / 10.0f;

  /// Less than this, and never more since the start: nothing is wired to the pin but ground.
  static constexpr float kWired_V = 5.0f;

  /// In place of less, or of no answer, once something was there: low, and not "not measured".
  static constexpr float kLeast_V = 0.25f;

  BoardMeter(AdcRegisters& adc, AdcCommonRegisters& common, const FactoryCalibration& factory)
      : adc_(adc), common_(common), factory_(factory) {}

  /// @pre it has its clock, of 84 MHz at most
  void start();

  /// Whenever the main loop comes round: takes what is converted and starts the next. Never waits.
  void maintain(std::int64_t now_ns);

  /// 0 where nothing is wired, and until the first conversion is done.
  float supply_V() const { return supply_V_; }

  /// Of the processor; not a number where it is not known.
  float temperature_C() const { return temperature_C_; }

 private:
  void take();
  void take_temperature(float raw, float ratio);
  void find_no_answer();

  AdcRegisters& adc_;
  AdcCommonRegisters& common_;
  const FactoryCalibration& factory_;
  std::int64_t due_ns_ = 0;
  bool converting_ = false;
  bool wired_ = false;
  std::uint32_t looks_ = 0;  // in vain
  float supply_V_ = 0.0f;
  float temperature_C_ = std::numeric_limits<float>::quiet_NaN();
};

}  // namespace hoof::firmware::stm32f405
