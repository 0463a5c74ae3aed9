// A clock that runs slower than the wall's, for a plant that is simulated slower than real time.
#pragma once

#include <cstdint>

#include "hal/monotonic_clock.h"

namespace hoof::firmware::board {

/// Limits of the firmware stay what they are: 20 ms are 20 ms of this clock.
class ScaledClock final : public hal::Clock {
 public:
  /// @param slow_down seconds of the wall per second of this clock, at least 1
  explicit ScaledClock(double slow_down) : slow_down_(slow_down), origin_ns_(wall_.now_ns()) {}

  std::int64_t now_ns() const override {
    const auto elapsed_ns = static_cast<double>(wall_.now_ns() - origin_ns_);
    return static_cast<std::int64_t>(elapsed_ns / slow_down_);
  }

 private:
  hal::MonotonicClock wall_;
  double slow_down_;
  std::int64_t origin_ns_;
};

}  // namespace hoof::firmware::board
