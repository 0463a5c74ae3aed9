// A CAN bus, and a serial line in its place for as long as nobody has spoken on CAN: a bench
// without a CAN adapter, an emulator that has no CAN. The first frame on any of a node's CAN buses
// shuts all its serial lines until the next reset, so that none can steer a robot that runs.
#pragma once

#include "hal/can_bus.h"

namespace hoof::hal {

/// Of all buses of one node.
struct SerialGate {
  bool can_spoke = false;
};

/// Main loop only.
/// @tparam Can the CAN bus, a final class  @tparam Serial a slcan::SlcanBus
template <typename Can, typename Serial>
class FallbackBus final : public CanBus {
 public:
  FallbackBus(Can& can, Serial& serial, SerialGate& gate)
      : can_(can), serial_(serial), gate_(gate) {}

  SendResult send(const CanFrame& frame) override {
    return by_serial() ? serial_.send(frame) : can_.send(frame);
  }
  void withdraw(std::uint32_t id) override {
    if (!by_serial()) can_.withdraw(id);
  }
  BusStatus status() const override { return by_serial() ? serial_.status() : can_.status(); }
  bool bus_off() const override { return by_serial() ? serial_.bus_off() : can_.bus_off(); }

  bool receive(CanFrame& frame) override {
    if (can_.receive(frame)) {
      gate_.can_spoke = true;
      return true;
    }
    if (!gate_.can_spoke) return serial_.receive(frame);
    serial_.close_for_good();
    return false;
  }

 private:
  bool by_serial() const { return !gate_.can_spoke && serial_.open(); }

  Can& can_;
  Serial& serial_;
  SerialGate& gate_;
};

}  // namespace hoof::hal
