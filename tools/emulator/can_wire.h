// The wire at the pins of one CAN controller.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hal/can_bus.h"

namespace hoof::tools::emulator {

class CanWire {
 public:
  virtual ~CanWire() = default;

  /// A frame for the wire, which arbitrates by itself. @return false: later
  virtual bool offer(const hal::CanFrame& frame) = 0;
  /// Takes back a frame that was offered. @return false: too late, or it cannot be known
  virtual bool withdraw(const hal::CanFrame& frame) = 0;
  /// The oldest frame that came.
  virtual bool take(hal::CanFrame& frame) = 0;
  /// Frames of ours that have left since the last call, in order.
  virtual std::vector<hal::CanFrame> take_sent() = 0;
  virtual hal::BusStatus status() const = 0;
  /// After bus-off: takes part again, error counters at zero.
  virtual void join_again() = 0;
};

/// Someone listens and acknowledges, and nobody else sends: where a board is alone at its start.
std::unique_ptr<CanWire> silent_wire();

/// A connection to a bus of ours; in process it tells which frames have left, and can come back
/// from bus-off. Of other buses the number sent is known: they are taken to leave in the order
/// offered.
std::unique_ptr<CanWire> wire_of(hal::CanBus& bus);

}  // namespace hoof::tools::emulator
