// The firmware's place on the buses of a lock-step run, whatever runs it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "firmware/app/parameters.h"
#include "firmware/app/telemetry.h"
#include "hal/clock.h"
#include "hil_bridge/wires.h"

namespace hoof::bridge {

class FirmwareNode {
 public:
  virtual ~FirmwareNode() = default;

  /// What has arrived until now is acted upon. Called after every exchange, in rising time.
  virtual void poll(std::int64_t now_ns) = 0;

  /// For recorders: what the firmware knew and did in its last tick, or as much as it tells on the
  /// bus.
  virtual const firmware::app::Telemetry& telemetry() const = 0;
};

/// Makes the node, connected to the wires; both outlive it.
using FirmwareFactory = std::function<std::unique_ptr<FirmwareNode>(Wires&, const hal::Clock&)>;

/// The control loop itself, in this process.
FirmwareFactory firmware_in_process(const firmware::app::Parameters& parameters);

}  // namespace hoof::bridge
