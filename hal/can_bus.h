// One node's connection to one CAN bus.
#pragma once

#include <cstdint>

#include "hal/can_frame.h"

namespace hoof::hal {

enum class SendResult : std::uint8_t {
  kQueued = 0,  // accepted; it goes out when arbitration lets it
  kFull,        // every mailbox or the send buffer is taken: try again later, nothing was sent
  kBusOff,      // the controller left the bus after too many errors
  kInvalid,     // the frame cannot exist (length, identifier, FD on a classic bus)
  kDown,        // the interface is not up
};

struct BusStatus {
  bool bus_off = false;
  bool error_passive = false;
  std::uint8_t transmit_error_count = 0;
  std::uint8_t receive_error_count = 0;
  std::uint8_t free = 3;       // frames that send() takes now; those of a bxCAN where not known
  std::uint64_t sent = 0;      // frames that left this node
  std::uint64_t received = 0;  // frames handed to this node
  std::uint64_t dropped = 0;   // frames lost on the way to this node (full queue, kernel drop)
  std::uint64_t error_frames = 0;
};

/// Non-blocking. A node never receives the frames it sent itself.
class CanBus {
 public:
  virtual SendResult send(const CanFrame& frame) = 0;

  /// Gives up what still waits to be sent under this standard identifier, so that a frame which is
  /// out of date does not go out behind a busy bus. One on the wire ends. Does nothing where frames
  /// cannot be called back (a kernel's queue).
  virtual void withdraw(std::uint32_t) {}

  /// Takes the oldest received frame, stamped with its arrival (end of frame) time.
  /// @return false when nothing waits; `frame` is then unchanged.
  virtual bool receive(CanFrame& frame) = 0;

  virtual BusStatus status() const = 0;

  /// status().bus_off, without the rest of it.
  virtual bool bus_off() const { return status().bus_off; }

 protected:
  ~CanBus() = default;  // never deleted through the interface: keeps malloc/free off the board
};

}  // namespace hoof::hal
