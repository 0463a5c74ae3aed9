// One of the foot's two buses in lock-step: what arrives was put there by the simulator's word,
// what is sent goes out at once, but no more than the simulated controller has room for.
#pragma once

#include <deque>

#include "hal/socketcan/socketcan_bus.h"

namespace hoof::firmware::board {

class SteppedConnection final : public hal::CanBus {
 public:
  explicit SteppedConnection(hal::SocketCanBus& socket) : socket_(socket) {}

  /// From now on: room for so many frames, and whether the controller has left its bus.
  void allow(int free, bool bus_off) {
    free_ = free;
    status_.bus_off = bus_off;
  }

  void put(const hal::CanFrame& frame) {
    if (waiting_.size() < kMostWaiting) {
      waiting_.push_back(frame);
    } else {
      ++status_.dropped;
    }
  }

  void clear() { waiting_.clear(); }

  hal::SendResult send(const hal::CanFrame& frame) override {
    if (status_.bus_off) return hal::SendResult::kBusOff;
    if (free_ <= 0) return hal::SendResult::kFull;
    const hal::SendResult result = socket_.send(frame);
    if (result == hal::SendResult::kQueued) {
      --free_;
      ++status_.sent;
    }
    return result;
  }

  bool receive(hal::CanFrame& frame) override {
    if (waiting_.empty()) return false;
    frame = waiting_.front();
    waiting_.pop_front();
    ++status_.received;
    return true;
  }

  hal::BusStatus status() const override { return status_; }

 private:
  static constexpr std::size_t kMostWaiting = 4096;  // of a flood from elsewhere

  hal::SocketCanBus& socket_;
  std::deque<hal::CanFrame> waiting_;
  hal::BusStatus status_;
  int free_ = 0;
};

}  // namespace hoof::firmware::board
