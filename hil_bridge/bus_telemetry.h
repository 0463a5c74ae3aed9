// What a firmware tells of itself on the buses, put together as if it had been asked in its
// process.
#pragma once

#include <cstdint>

#include "firmware/app/telemetry.h"
#include "firmware/protocol/codec.h"
#include "hal/can_frame.h"

namespace hoof::bridge {

/// Commands, replies and tick are of the last millisecond; mode and faults as of the last heartbeat
/// (100 ms, at changes 10 ms), the rest as of the last telemetry frame of its kind (10 ms). Values
/// have the resolution of the wire; what is on no wire keeps its default.
class BusTelemetry {
 public:
  void take(const hal::CanFrame& frame, std::int64_t now_ns);
  const firmware::app::Telemetry& telemetry() const { return telemetry_; }

 private:
  bool take_drive(const hal::CanFrame& frame);
  void take_foot(const hal::CanFrame& frame);

  firmware::app::Telemetry telemetry_;
};

}  // namespace hoof::bridge
