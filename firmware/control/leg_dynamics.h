// Torques that move the leg as wanted, without the sand: inverse dynamics of two rigid links with
// the foot fixed to the shank and a geared rotor at each joint.
#pragma once

#include "firmware/control/leg_kinematics.h"
#include "firmware/control/settings.h"

namespace hoof::firmware::control {

class LegDynamics {
 public:
  explicit LegDynamics(const LegModelSettings& settings);

  /// Drive torques for the given motion: gravity, link inertia, reflected rotor inertia, friction.
  /// Source: Lagrange's equations in (h, s), see the .cpp file. The fields are Nm.
  LegAngles torque_Nm(const LegSines& q, LegAngles velocity_rad_s,
                      LegAngles acceleration_rad_s2) const;
  LegAngles torque_Nm(LegAngles q, LegAngles velocity_rad_s, LegAngles acceleration_rad_s2) const {
    return torque_Nm(LegSines(q), velocity_rad_s, acceleration_rad_s2);
  }

  /// By how much each drive's friction may differ from that model. The fields are Nm.
  LegAngles friction_doubt_Nm(LegAngles velocity_rad_s) const;

 private:
  float a_;  // inertia of everything about the hip, shank and foot as a point at the knee, kg m2
  float b_;  // inertia of shank and foot about the knee, kg m2
  float c_;  // coupling, kg m2
  float moment_h_;  // mass moments for gravity, kg m
  float moment_s_;
  float rotor_;
  float friction_;
  float viscous_;
};

inline constexpr float kFrictionSpeed_rad_s = 0.05f;

/// Coulomb friction with the jump at zero speed smoothed over some 0.05 rad/s, so that noise of a
/// speed near zero does not make torque, and viscous friction: F v / (|v| + 0.05) + b v.
inline float smooth_friction_Nm(float friction_Nm, float viscous_Nm_s_rad, float velocity_rad_s) {
  return friction_Nm * velocity_rad_s / (absolute(velocity_rad_s) + kFrictionSpeed_rad_s) +
         viscous_Nm_s_rad * velocity_rad_s;
}

/// What the smoothing leaves out of +-F: all of it at rest, where friction holds with anything
/// between -F and F.
inline float smooth_friction_doubt_Nm(float friction_Nm, float velocity_rad_s) {
  return friction_Nm * kFrictionSpeed_rad_s / (absolute(velocity_rad_s) + kFrictionSpeed_rad_s);
}

}  // namespace hoof::firmware::control
