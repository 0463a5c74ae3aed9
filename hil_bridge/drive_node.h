// What the bus sees of one drive of the plant.
#pragma once

#include <cstdint>

#include "firmware/protocol/codec.h"
#include "hal/can_bus.h"
#include "sim/drive/drive.h"

namespace hoof::bridge {

/// Reads command frames of one drive, hands them to the drive model and answers each with the
/// drive's state at that moment, as AK and mini-cheetah drives do: enter, exit and zero are
/// answered, too, and a command to a drive that is not entered is answered but has no effect. Uses
/// the firmware's own codec, so a scale factor cannot differ between the two ends of the wire.
///
/// The torque ends 20 ms after the last command by the drive model's own timer
/// (DriveSettings::command_timeout_s), which runs in plant time.
class DriveNode {
 public:
  /// @param bus the drive's own connection; both must outlive the node
  DriveNode(hal::CanBus& bus, firmware::protocol::Drive which, sim::Drive& drive)
      : bus_(bus), which_(which), drive_(drive) {}

  /// Takes all waiting frames. Call it when the plant stands at the time the frames arrived.
  void poll();

  std::uint64_t commands() const { return commands_; }
  /// Frames under this drive's identifier that it could not read.
  std::uint64_t malformed() const { return malformed_; }
  /// Answers that the bus would not take.
  std::uint64_t unsent() const { return unsent_; }

 private:
  void take(const hal::CanFrame& frame);
  void obey(const firmware::protocol::DriveOrder& order);
  void answer();

  hal::CanBus& bus_;
  firmware::protocol::Drive which_;
  sim::Drive& drive_;
  std::uint64_t commands_ = 0;
  std::uint64_t malformed_ = 0;
  std::uint64_t unsent_ = 0;
};

}  // namespace hoof::bridge
