// The way to a firmware elsewhere that goes in lock-step: CAN interfaces, or serial lines.
#pragma once

#include <cstdint>
#include <string>

#include "hal/can_bus.h"

namespace hoof::bridge {

class FootLine {
 public:
  virtual ~FootLine() = default;

  /// Who is at its other end, for messages: "hoof-firmware on vcan0".
  virtual std::string foot() const = 0;
  /// What may be wrong where it does not begin, and what to do.
  virtual std::string advice() const = 0;

  /// True where one connection carries both buses; it keeps frames of both in order.
  virtual bool one_interface() const = 0;
  virtual hal::CanBus& bus(int index) = 0;

  /// Until something has come on bus 0, or as long as that.
  virtual void wait(std::int64_t longest_ns) = 0;

  /// Frames given to a bus wait here until now. Those of bus 1 are there before any of bus 0: what
  /// tells the firmware to look is on bus 0. @return false where an interface takes no more
  virtual bool flush() = 0;

  /// Why the other end can never answer again; empty while that is not known.
  virtual std::string gone() { return {}; }
};

}  // namespace hoof::bridge
