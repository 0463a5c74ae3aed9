// What a fault of the timeline acts on: frames, a node, a wire or a drive.
#pragma once

#include <array>
#include <optional>

#include "hil_bridge/effects/frame_effect.h"
#include "hil_bridge/fault_spec.h"
#include "sim/effects/drive_effect.h"
#include "sim/multibody/rig.h"

namespace hoof::bridge {

/// Only what the kind of fault needs is set.
struct FaultTarget {
  std::optional<FrameEffectKind> effect;  // with `frames`
  std::optional<FrameTarget> frames;
  bool floods = false;  // `bus` gets a stranger
  int bus = 0;
  std::optional<sim::DriveEffectKind> drive_effect;
  std::optional<sim::Joint> joint;  // a drive's fault, or a drive's node
};

/// @param drives which of the rig's joints have a drive
/// @throws sim::ConfigError naming file, line, key, value and what there is
FaultTarget find_target(const FaultSpec& fault, const std::array<bool, sim::kJointCount>& drives);

/// True where the fault reaches the firmware in ways that no log of the bus shows: by its board, by
/// its own connection, or by its frames on their way to the wire.
bool unseen_by_bus(const FaultSpec& fault, const FaultTarget& target);

}  // namespace hoof::bridge
