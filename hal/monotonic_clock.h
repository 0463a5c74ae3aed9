// The machine's own monotonic clock: time since an arbitrary origin (boot on Linux), never stepped.
#pragma once

#include <chrono>
#include <cstdint>

#include "hal/clock.h"

namespace hoof::hal {

/// CLOCK_MONOTONIC through std::chrono. SocketCanBus stamps frames on this same clock.
class MonotonicClock final : public Clock {
 public:
  std::int64_t now_ns() const override {
    const auto since_origin = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_origin).count();
  }
};

}  // namespace hoof::hal
