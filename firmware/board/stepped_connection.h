// One of the foot's two buses in lock-step: what arrives was put there by the simulator's word,
// what is sent goes out at once, but no more than the simulated controller has room for.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/app/fixed_queue.h"
#include "hal/can_bus.h"

namespace hoof::firmware::board {

/// @tparam Way that the frames go by, a final hal::CanBus  @tparam kMostWaiting one more is dropped
template <typename Way, std::size_t kMostWaiting>
class SteppedConnection final : public hal::CanBus {
 public:
  explicit SteppedConnection(Way& way) : way_(way) {}

  /// From now on: room for so many frames, and whether the controller has left its bus.
  void allow(int free, bool bus_off) {
    status_.free = static_cast<std::uint8_t>(free);
    status_.bus_off = bus_off;
  }

  void put(const hal::CanFrame& frame) {
    if (!waiting_.put(frame)) ++status_.dropped;
  }

  void clear() {
    while (!waiting_.empty()) waiting_.drop();
  }

  hal::SendResult send(const hal::CanFrame& frame) override {
    if (status_.bus_off) return hal::SendResult::kBusOff;
    if (status_.free == 0) return hal::SendResult::kFull;
    const hal::SendResult result = way_.send(frame);
    if (result == hal::SendResult::kQueued) {
      --status_.free;
      ++status_.sent;
    }
    return result;
  }

  bool receive(hal::CanFrame& frame) override {
    if (waiting_.empty()) return false;
    frame = waiting_.front();
    waiting_.drop();
    ++status_.received;
    return true;
  }

  hal::BusStatus status() const override { return status_; }
  bool bus_off() const override { return status_.bus_off; }

 private:
  Way& way_;
  app::FixedQueue<hal::CanFrame, kMostWaiting> waiting_;
  hal::BusStatus status_;
};

}  // namespace hoof::firmware::board
