// The dictionary's names and ranges against the types of control and safety, which must not know
// the dictionary: checked here, where all are known, at compile time.
#pragma once

#include "firmware/control/types.h"
#include "firmware/protocol/messages.h"
#include "firmware/safety/limits.h"
#include "firmware/safety/torque_gate.h"

namespace hoof::firmware::app {

namespace agreement {

constexpr bool same(control::Mode a, protocol::Mode b) {
  return static_cast<int>(a) == static_cast<int>(b);
}
static_assert(same(control::Mode::kOff, protocol::Mode::kOff));
static_assert(same(control::Mode::kHoming, protocol::Mode::kHoming));
static_assert(same(control::Mode::kReady, protocol::Mode::kReady));
static_assert(same(control::Mode::kRunning, protocol::Mode::kRunning));
static_assert(same(control::Mode::kDampedStop, protocol::Mode::kDampedStop));
static_assert(same(control::Mode::kEmergencyOff, protocol::Mode::kEmergencyOff));
static_assert(same(control::Mode::kFault, protocol::Mode::kFault));

/// The bit must have the name in the dictionary's table.
constexpr bool named(std::span<const protocol::ValueName> table, std::uint32_t bits,
                     std::string_view name) {
  for (const protocol::ValueName& value : table) {
    if (value.name == name) return bits == 1u << value.value;
  }
  return false;
}
constexpr bool fault_named(control::FaultBits bits, std::string_view name) {
  return named(protocol::kFaultBitNames, bits, name);
}
static_assert(fault_named(control::fault::kSyncLost, "sync_lost"));
static_assert(fault_named(control::fault::kDriveLost, "drive_lost"));
static_assert(fault_named(control::fault::kBusOff, "bus_off"));
static_assert(fault_named(control::fault::kDriveError, "drive_error"));
static_assert(fault_named(control::fault::kImplausibleReply, "implausible_reply"));
static_assert(fault_named(control::fault::kOverTemperature, "over_temperature"));
static_assert(fault_named(control::fault::kOverload, "overload"));
static_assert(fault_named(control::fault::kNotFollowing, "not_following"));
static_assert(fault_named(control::fault::kHomingFailed, "homing_failed"));
static_assert(fault_named(control::fault::kToeJammed, "toe_jammed"));
static_assert(fault_named(control::fault::kToeStalled, "toe_stalled"));
static_assert(fault_named(control::fault::kOutsideTravel, "outside_travel"));
static_assert(fault_named(control::fault::kPathUnreachable, "path_unreachable"));
static_assert(fault_named(control::fault::kEmergencyStop, "emergency_stop"));
static_assert(fault_named(control::fault::kInvalidWish, "invalid_wish"));
static_assert(fault_named(control::fault::kOverrun, "overrun"));
static_assert(fault_named(control::fault::kStorage, "storage"));
static_assert(fault_named(control::fault::kBrownOut, "brown_out"));
static_assert(fault_named(control::fault::kUnexpectedReset, "unexpected_reset"));

constexpr bool limit_named(safety::LimitBits bits, std::string_view name) {
  return named(protocol::kLimitBitNames, bits, name);
}
static_assert(limit_named(safety::limit::kTorque, "torque"));
static_assert(limit_named(safety::limit::kTorqueRate, "torque_rate"));
static_assert(limit_named(safety::limit::kDistance, "distance"));
static_assert(limit_named(safety::limit::kTravel, "travel"));
static_assert(limit_named(safety::limit::kVelocity, "velocity"));
static_assert(limit_named(safety::limit::kGain, "gain"));
static_assert(limit_named(safety::limit::kRefused, "refused"));
static_assert(limit_named(safety::limit::kLatched, "latched"));
static_assert(limit_named(safety::limit::kOverload, "overload"));

/// What the gate lets through must fit the wire, half a code of torque included, or packing would
/// change it once more.
constexpr bool fits(std::size_t joint) {
  const safety::JointLimits& limits = safety::kLimits[joint];
  const protocol::DriveRange& range = protocol::kDriveRanges[joint];
  return limits.feed_forward_Nm == range.torque_Nm && limits.torque_Nm < range.torque_Nm &&
         limits.velocity_rad_s <= range.velocity_rad_s && limits.kp_Nm_rad <= range.kp_Nm_rad &&
         limits.kd_Nm_s_rad <= range.kd_Nm_s_rad && limits.upper_rad < range.position_rad &&
         -limits.lower_rad < range.position_rad && limits.end_of_range_rad < range.position_rad;
}
static_assert(fits(0) && fits(1) && fits(2));

}  // namespace agreement

}  // namespace hoof::firmware::app
