// Frames that may wait for a free mailbox: heartbeat, acknowledges, telemetry.
#pragma once

#include "firmware/app/fixed_queue.h"
#include "hal/can_bus.h"

namespace hoof::firmware::app {

class Outbox {
 public:
  /// @return false when full; the frame is then dropped
  bool put(const hal::CanFrame& frame) { return frames_.put(frame); }

  bool empty() const { return frames_.empty(); }

  /// Sends in order until empty or until the bus takes no more.
  void flush(hal::CanBus& bus) {
    while (!frames_.empty() && bus.send(frames_.front()) == hal::SendResult::kQueued) {
      frames_.drop();
    }
  }

 private:
  FixedQueue<hal::CanFrame, 16> frames_;
};

}  // namespace hoof::firmware::app
