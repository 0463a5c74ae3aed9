// The firmware's time while a simulator tells it: it stands still between two words of the
// simulator, and runs on with the wall's where the simulator has gone.
#pragma once

#include <cstdint>

#include "hal/monotonic_clock.h"

namespace hoof::firmware::board {

class LockStepClock final : public hal::Clock {
 public:
  std::int64_t now_ns() const override {
    return running_ ? at_ns_ + wall_.now_ns() - since_ns_ : at_ns_;
  }

  bool running() const { return running_; }

  /// Stands from now on; never goes back within one life of the firmware.
  void stand_at(std::int64_t t_ns) {
    at_ns_ = t_ns;
    running_ = false;
  }

  void run_on() {
    if (running_) return;
    since_ns_ = wall_.now_ns();
    running_ = true;
  }

 private:
  hal::MonotonicClock wall_;
  std::int64_t at_ns_ = 0;
  std::int64_t since_ns_ = wall_.now_ns();
  bool running_ = true;
};

}  // namespace hoof::firmware::board
