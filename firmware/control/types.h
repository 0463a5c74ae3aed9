// What control, gate and loop pass to each other. All angles are joint angles (after homing), all
// torques at the joint; positive directions are fixed in firmware/README.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hoof::firmware::control {

enum class Joint : std::uint8_t { kToe = 0, kHip = 1, kKnee = 2 };
inline constexpr std::size_t kJointCount = 3;
constexpr std::size_t index(Joint joint) {
  return static_cast<std::size_t>(joint);
}

inline constexpr float kTick_s = 0.001f;  // one SYNC to the next, in control time

template <typename T>
using PerJoint = std::array<T, kJointCount>;

/// Which drives exist on this rig. A joint that is not there is neither commanded nor watched.
struct JointPresence {
  bool toe = true;
  bool leg = true;  // hip and knee come together

  constexpr bool has(std::size_t joint) const { return joint == 0 ? toe : leg; }
};

enum class Mode : std::uint8_t {
  kOff = 0,       // exit frames, drives free
  kHoming,        // drives entered, toe seeks its closed end stop
  kReady,         // toes at their angle, leg at rest (going to the start of the path at first)
  kRunning,       // leg follows the stance path
  kDampedStop,    // every joint damped only, until at rest; then off, or fault
  kEmergencyOff,  // exit frames, latched
  kFault,         // exit frames, latched
};

/// One bit each; ranges: 0-3 communication, 4-8 drives, 9-13 motion, 14-17 orders and firmware,
/// 18-19 board. Twenty at most: they share a word of the fault log with twelve limit bits.
using FaultBits = std::uint32_t;
namespace fault {
inline constexpr FaultBits kSyncLost = 1u << 0;
inline constexpr FaultBits kDriveLost = 1u << 1;
inline constexpr FaultBits kBusOff = 1u << 2;
inline constexpr FaultBits kDriveError = 1u << 4;
inline constexpr FaultBits kImplausibleReply = 1u << 5;
inline constexpr FaultBits kOverTemperature = 1u << 6;
inline constexpr FaultBits kOverload = 1u << 7;
inline constexpr FaultBits kNotFollowing = 1u << 8;
inline constexpr FaultBits kHomingFailed = 1u << 9;
inline constexpr FaultBits kToeJammed = 1u << 10;
inline constexpr FaultBits kToeStalled = 1u << 11;
inline constexpr FaultBits kOutsideTravel = 1u << 12;
inline constexpr FaultBits kPathUnreachable = 1u << 13;
inline constexpr FaultBits kEmergencyStop = 1u << 14;
inline constexpr FaultBits kInvalidWish = 1u << 15;
inline constexpr FaultBits kOverrun = 1u << 16;
inline constexpr FaultBits kStorage = 1u << 17;
inline constexpr FaultBits kBrownOut = 1u << 18;
inline constexpr FaultBits kUnexpectedReset = 1u << 19;
}  // namespace fault

struct JointState {
  float position_rad = 0.0f;  // joint angle: reading less the joint's zero
  float reading_rad = 0.0f;   // as the drive told it
  float velocity_rad_s = 0.0f;
  float torque_Nm = 0.0f;
  float temperature_C = 0.0f;
  std::uint8_t error = 0;        // the drive's own code, 0 none
  bool received = false;         // at least one reply since start
  bool referenced = false;       // the zero is known: homed, or an absolute encoder
  std::int64_t received_ns = 0;  // when, on the local clock
};

/// torque = kp (position - p) + kd (velocity - v) + torque_Nm, computed in the drive.
struct JointCommand {
  float position_rad = 0.0f;
  float velocity_rad_s = 0.0f;
  float kp_Nm_rad = 0.0f;
  float kd_Nm_s_rad = 0.0f;
  float torque_Nm = 0.0f;
};

inline float predicted_torque_Nm(const JointCommand& c, const JointState& s) {
  return c.kp_Nm_rad * (c.position_rad - s.position_rad) +
         c.kd_Nm_s_rad * (c.velocity_rad_s - s.velocity_rad_s) + c.torque_Nm;
}

enum class DriveAction : std::uint8_t {
  kExit = 0,  // motor off
  kEnter,     // motor on
  kCommand,
};

struct JointWish {
  DriveAction action = DriveAction::kExit;
  JointCommand command;
};

/// What the controller would like each drive to do; the gate has the last word.
struct Wish {
  Mode mode = Mode::kOff;
  PerJoint<JointWish> joint{};
};

}  // namespace hoof::firmware::control
