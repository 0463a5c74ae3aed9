// Hard ceilings of the torque gate. Compiled in on purpose: no file and no message changes them.
#pragma once

#include <cstdint>

#include "firmware/control/types.h"
#include "firmware/safety/drive_data.h"

namespace hoof::firmware::safety {

struct JointLimits {
  float torque_Nm;         // of what the drive will make of the whole command
  float torque_rate_Nm_s;  // change of that from tick to tick
  float feed_forward_Nm;   // what the wire can carry; the gate corrects within it
  float distance_rad;      // of the position target from the measured position
  float lower_rad;         // travel of the joint
  float upper_rad;
  float velocity_rad_s;  // of the speed target
  float kp_Nm_rad;
  float kd_Nm_s_rad;
  float plausible_rad_s;   // a measured position cannot move faster
  float end_of_range_rad;  // readings at or beyond are a saturated code, not an angle
  float drift_rad;         // of the readings from the sum of the reported speeds
  float following_Nm;      // of the reported torque from the one that was asked
  float stuck_Nm;          // change of torque under which a reading cannot stand still
  float stop_kd_Nm_s_rad;  // damping that replaces a command after a fault
};

inline constexpr JointLimits kToeLimits{
    .torque_Nm = 10.0f,  // sand turns a toe with 1.5 Nm, a jam is called at 4; the drive has 24
    .torque_rate_Nm_s = 3000.0f,  // ceiling in 3.3 ms: no blow from one wrong command
    .feed_forward_Nm = 24.0f,     // end of the wire's codes
    .distance_rad = 0.125f,   // at 250 Nm/rad the torque binds at 0.04; this is for softer settings
    .lower_rad = -0.1f,       // closed end stop at 0, found with an error
    .upper_rad = 1.0f,        // 40 degrees, and room for sand that forces the toes open
    .velocity_rad_s = 10.0f,  // five times the opening speed
    .kp_Nm_rad = 500.0f,      // end of the wire's codes
    .kd_Nm_s_rad = 5.0f,      // end of the wire's codes
    .plausible_rad_s = 45.0f,    // end of the wire's codes, beyond the drive's no-load speed
    .end_of_range_rad = 12.49f,  // end of the wire's codes less 26 of them
    .drift_rad = 0.03f,          // see kDriftMemory_s
    .following_Nm = 2.5f,        // a quarter of the ceiling
    .stuck_Nm = 4.0f,            // friction bears 1; 3 wind up the gear by three codes
    .stop_kd_Nm_s_rad = 2.4f,    // damping ratio 0.7 at the default stiffness
};

/// The travel differs between hip and knee; everything else is common.
constexpr JointLimits leg_limits(float lower_rad, float upper_rad) {
  return {
      // All that the drive has; 1.35 times the 235 Nm of the paper's fastest stance: clips none.
      .torque_Nm = kLegDrive.peak_torque_Nm,
      .torque_rate_Nm_s = 100e3f,  // ceiling in 3.2 ms; a foot fall takes up to 75 a tick
      .feed_forward_Nm = 400.0f,   // end of the wire's codes
      .distance_rad = 0.1f,        // 5 cm at the foot
      .lower_rad = lower_rad,
      .upper_rad = upper_rad,
      .velocity_rad_s = 5.0f,      // 2.7 times the 1.82 rad/s of the fastest path
      .kp_Nm_rad = 20000.0f,       // end of the wire's codes
      .kd_Nm_s_rad = 500.0f,       // end of the wire's codes
      .plausible_rad_s = 20.0f,    // end of the wire's codes
      .end_of_range_rad = 3.19f,   // end of the wire's codes less 100 of them
      .drift_rad = 0.02f,          // see kDriftMemory_s; 1 cm at the foot
      .following_Nm = 80.0f,       // a quarter of the ceiling
      .stuck_Nm = 30.0f,           // friction bears 10; 20 wind up the gear by ten codes
      .stop_kd_Nm_s_rad = 200.0f,  // 200 Nm of load sink at 1 rad/s
  };
}

/// The stance path needs hip 0.35 to 0.82 and knee -1.42 to -0.94 rad; beyond that what a leg that
/// hangs straight (knee 0) or is folded needs.
inline constexpr control::PerJoint<JointLimits> kLimits{kToeLimits, leg_limits(-1.2f, 1.6f),
                                                        leg_limits(-2.7f, 0.05f)};

/// A ceiling is no more than the drive has, and more than what a warm drive is left with; that far
/// it may fall at once (after a reset, say) without a change beyond the rate.
constexpr bool ceiling_fits(const JointLimits& limits, const DriveData& drive) {
  const float fall_Nm = limits.torque_Nm - drive.continuous_torque_Nm;
  return limits.torque_Nm <= drive.peak_torque_Nm && fall_Nm > 0.0f &&
         fall_Nm <= limits.torque_rate_Nm_s * control::kTick_s;
}
static_assert(ceiling_fits(kLimits[0], kDrives[0]) && ceiling_fits(kLimits[1], kDrives[1]) &&
              ceiling_fits(kLimits[2], kDrives[2]));

/// Beyond its travel by this much a joint is not where it can be. 3 degrees.
inline constexpr float kTravelMargin_rad = 0.05f;

/// Insulation class B bears 130 degC; 30 less for the winding being hotter than its sensor.
inline constexpr float kHighestTemperature_C = 100.0f;

/// Heat as a share of what the continuous torque would end at. From the first on the ceiling of
/// torque falls, at 1 it is the continuous torque; beyond the last the torque is not ours.
inline constexpr float kWarm = 0.9f;
inline constexpr float kOverheated = 1.1f;

/// How long a deviation of reading from reported speed is remembered. What the bounds of drift_rad
/// must bear (toe / leg): speed codes that are cut instead of rounded, 22 / 10 mrad/s for this
/// long, 2.2 / 1.0 mrad; position codes 0.4 / 0.1; the lag of the drive's speed filter (200 Hz: 0.8
/// ms) when the foot slips or strikes, 20 / 10 rad/s of change, 16 / 8; play of a gear whose
/// encoders sit on both sides, 3 / 3. Measured on rigid ground, where strikes are hardest: 1.1
/// / 5.2 mrad. Found is then a jump beyond the bound, and a drift of 0.3 / 0.2 rad/s or more.
inline constexpr float kDriftMemory_s = 0.1f;

/// Across more ticks than that nothing is integrated: SYNC numbers were left out (had so much time
/// passed, the reply would be stale).
inline constexpr std::uint32_t kLongestGap_ticks = 20;

/// A drive that does not follow for so many ticks more than it does has lost its torque.
inline constexpr int kNotFollowingTicks = 100;

/// So many replies of one reading make it a still one: 20 Nm more than friction turn a free rotor
/// of the leg by 40 codes in ten ticks, 3 Nm that of a toe by 30.
inline constexpr int kStuckReplies = 10;

/// The first ones do not count: what brings a rotor to rest, or turns it back, acts on one code for
/// two ticks each way (those 20 Nm: 1.6 codes). Measured on grains and on rigid ground, over all
/// still readings: 1.1 Nm (toe) and 16 Nm (leg).
inline constexpr int kSettlingReplies = 4;

/// Without a reply, or without SYNC, for so long, the foot stops. The drives drop their torque
/// after the same time without a command.
inline constexpr std::int64_t kFreshness_ns = 20'000'000;

}  // namespace hoof::firmware::safety
