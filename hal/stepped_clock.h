// A clock that stands still until the simulator moves it: every node of a lock-step run reads the
// same simulated time, however long the simulator computes.
#pragma once

#include <cassert>
#include <cstdint>

#include "hal/clock.h"

namespace hoof::hal {

class SteppedClock final : public Clock {
 public:
  std::int64_t now_ns() const override { return now_ns_; }

  /// @param t_ns new time; not before the present one (the contract of Clock is monotonic time).
  void advance_to(std::int64_t t_ns) {
    assert(t_ns >= now_ns_);
    now_ns_ = t_ns;
  }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace hoof::hal
