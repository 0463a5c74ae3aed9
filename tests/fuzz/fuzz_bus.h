// A bus end in the fuzzer's hand: it says what arrives, what is taken, and whether the bus is
// there.
#pragma once

#include <vector>

#include "hal/can_bus.h"

namespace hoof::tests::fuzz {

class FuzzBus final : public hal::CanBus {
 public:
  static constexpr int kEndless = 1 << 20;

  hal::SendResult send(const hal::CanFrame& frame) override {
    if (bus_off) return hal::SendResult::kBusOff;
    if (static_cast<int>(sent.size()) >= room) return hal::SendResult::kFull;
    sent.push_back(frame);
    return hal::SendResult::kQueued;
  }

  bool receive(hal::CanFrame& frame) override {
    if (next_ == arriving.size()) {
      arriving.clear();
      next_ = 0;
      return false;
    }
    frame = arriving[next_++];
    return true;
  }

  hal::BusStatus status() const override { return {.bus_off = bus_off}; }

  std::vector<hal::CanFrame> arriving;  // handed out at the next poll
  std::vector<hal::CanFrame> sent;      // taken since last cleared
  int room = kEndless;                  // frames that `sent` may hold
  bool bus_off = false;

 private:
  std::size_t next_ = 0;
};

}  // namespace hoof::tests::fuzz
