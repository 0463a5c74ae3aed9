// Frames that may wait for a free mailbox: heartbeat, acknowledges, telemetry.
#pragma once

#include <array>

#include "hal/can_bus.h"

namespace hoof::firmware::app {

class Outbox {
 public:
  /// @return false when full; the frame is then dropped
  bool put(const hal::CanFrame& frame) {
    if (count_ == kSize) return false;
    frames_[(first_ + count_++) % kSize] = frame;
    return true;
  }

  /// Sends in order until empty or until the bus takes no more.
  void flush(hal::CanBus& bus) {
    while (count_ > 0 && bus.send(frames_[first_]) == hal::SendResult::kQueued) {
      first_ = (first_ + 1) % kSize;
      --count_;
    }
  }

 private:
  static constexpr std::size_t kSize = 16;
  std::array<hal::CanFrame, kSize> frames_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace hoof::firmware::app
