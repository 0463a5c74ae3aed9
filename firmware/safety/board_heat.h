// The temperature of the board's processor.
#pragma once

#include "firmware/control/types.h"

namespace hoof::firmware::safety {

/// Processors of the usual kind are made for 105 C (DS8626, junction temperature, suffix 6), and
/// the factory's calibration of their sensor is good for 5 C.
inline constexpr float kHottestBoard_C = 100.0f;

class BoardHeatWatch {
 public:
  /// Once per tick. One hot tick is a disturbed measurement.
  /// @param temperature_C not a number where it is not measured
  /// @return kOverTemperature with the second hot tick in a row, and with each that follows it
  control::FaultBits note(float temperature_C);

 private:
  bool was_hot_ = false;
};

}  // namespace hoof::firmware::safety
