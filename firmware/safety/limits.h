// Hard ceilings of the torque gate. Compiled in on purpose: no file and no message changes them.
#pragma once

#include <cstdint>

#include "firmware/control/types.h"

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
  float stop_kd_Nm_s_rad;  // damping that replaces a command after a fault
};

/// Toe. Torque: the sand turns a toe with up to 1.5 Nm, a jam is called at 4; 10 leaves the 24 Nm
/// of the drive unused, which gears and linkage would still bear. Rate: full torque in 3.3 ms, so a
/// single wrong command cannot be a blow. Distance: half of what 10 Nm need at 40 Nm/rad, the
/// softest setting of use. Travel: 0 to 40 degrees with room for a soft stop and for sand forcing
/// the toes open. Speed: five times the toe's own 2 rad/s. Gains: end of the wire. Plausible: the
/// drive's no-load class, 45 rad/s.
///
/// Hip and knee. Torque: 1.5 times the 235 Nm of the paper's fastest stance, so that no traction
/// test is clipped. Rate: ceiling in 3.5 ms; a foot fall that changes joint speed by 0.5 rad/s in a
/// tick moves the damping term by 75 Nm. Distance: 0.1 rad are 5 cm at the foot. Travel: the
/// elliptical path needs hip 0.35 to 0.82 and knee -1.42 to -0.94 rad; beyond that what a leg that
/// hangs straight (knee 0) or is folded needs. Speed: 2.7 times the 1.82 rad/s of the fastest path.
inline constexpr control::PerJoint<JointLimits> kLimits{{
    {10.0f, 3000.0f, 24.0f, 0.125f, -0.1f, 1.0f, 10.0f, 500.0f, 5.0f, 45.0f, 12.49f, 2.4f},
    {350.0f, 100e3f, 400.0f, 0.1f, -1.2f, 1.6f, 5.0f, 20000.0f, 500.0f, 20.0f, 3.19f, 200.0f},
    {350.0f, 100e3f, 400.0f, 0.1f, -2.7f, 0.05f, 5.0f, 20000.0f, 500.0f, 20.0f, 3.19f, 200.0f},
}};

/// Beyond its travel by this much a joint is not where it can be. 3 degrees.
inline constexpr float kTravelMargin_rad = 0.05f;

/// Insulation class B bears 130 degC; 30 less for the winding being hotter than its sensor.
inline constexpr float kHighestTemperature_C = 100.0f;

/// Without a reply, or without SYNC, for so long, the foot stops. The drives drop their torque
/// after the same time without a command.
inline constexpr std::int64_t kFreshness_ns = 20'000'000;

}  // namespace hoof::firmware::safety
