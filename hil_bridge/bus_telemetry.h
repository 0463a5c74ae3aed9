// What a firmware in another process, or on a board, lets others know: its telemetry as read from
// the frames on the bus.
#pragma once

#include <array>

#include "firmware/app/telemetry.h"
#include "firmware/protocol/messages.h"
#include "hal/can_frame.h"

namespace hoof::bridge {

/// Coarser than the firmware's own: angles of the toe and of the foot come at 100 Hz, the counters
/// at 10 Hz, and what no frame tells stays zero. Commands and replies are those of every tick.
class BusTelemetry {
 public:
  /// Any frame on either bus, in order.
  void take(const hal::CanFrame& frame, std::int64_t now_ns);

  const firmware::app::Telemetry& latest() const { return telemetry_; }
  /// Frames that only the foot sends.
  std::uint64_t foot_frames() const { return foot_frames_; }

 private:
  bool take_drives(const hal::CanFrame& frame, std::int64_t now_ns);
  bool take_status(const hal::CanFrame& frame);
  void take_measurements(const hal::CanFrame& frame);

  firmware::app::Telemetry telemetry_;
  float toe_zero_rad_ = 0.0f;  // reading at angle 0, as homing found it
  std::uint64_t foot_frames_ = 0;
};

}  // namespace hoof::bridge
