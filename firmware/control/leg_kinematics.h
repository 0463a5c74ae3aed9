// The leg as two links in the x-z plane.
//
//   symbol  meaning                                                              unit
//   h       thigh angle from straight down, positive forward (rotation about -y)  rad
//   k       shank against thigh, positive forward; the knee bends with k < 0      rad
//   s       shank from straight down, h + k                                       rad
//   l1 l2   thigh; shank from knee to the sole point                              m
//   x z     sole point from the hip, x forward, z up                              m
#pragma once

#include "firmware/control/math.h"

namespace hoof::firmware::control {

struct LegAngles {
  float hip_rad = 0.0f;
  float knee_rad = 0.0f;
};

/// Sole point, velocity or acceleration of it, or a force on it, in the x-z plane.
struct PlaneVector {
  float x = 0.0f;
  float z = 0.0f;
};

/// d(x, z)/d(h, k).
struct LegJacobian {
  float x_h = 0.0f;
  float x_k = 0.0f;
  float z_h = 0.0f;
  float z_k = 0.0f;
};

struct LegInverse {
  LegAngles angles;
  bool reachable = true;  // false: the nearest posture inside the reach is given instead
};

/// Of the angles h, s and k.
struct LegSines {
  explicit LegSines(LegAngles q)
      : h(sin_cos(q.hip_rad)), s(sin_cos(q.hip_rad + q.knee_rad)), k(sin_cos(q.knee_rad)) {}

  SinCos h;
  SinCos s;
  SinCos k;
};

/// A posture, and all that a control tick wants to know of it again and again: each sine is
/// reckoned once. LegKinematics makes it.
struct LegPosture {
  LegAngles q;
  LegSines sines;
  PlaneVector foot_m;
  LegJacobian jacobian;
  float inverse_determinant;  // of the Jacobian; damped where the leg is nearly stretched
};

class LegKinematics {
 public:
  /// Both lengths in metres, positive.
  constexpr LegKinematics(float thigh_m, float shank_m) : l1_(thigh_m), l2_(shank_m) {}

  PlaneVector foot_m(LegAngles q) const { return foot_m(LegSines(q)); }

  /// The posture with the knee bent backwards (k < 0). A stretched leg has no bending speed along
  /// its line, and a fully folded one no direction: the reach is kept between 1 % above the
  /// difference and 0.1 % below the sum of the link lengths.
  LegInverse angles(PlaneVector foot_m) const;

  LegJacobian jacobian(LegAngles q) const { return posture(q).jacobian; }

  LegPosture posture(LegAngles q) const;
  /// Makes `posture` that of q; where it already is, bit for bit, that costs nothing.
  void update(LegPosture& posture, LegAngles q) const;

  /// Speed of the sole point, J qdot.
  PlaneVector foot_velocity_m_s(const LegPosture& p, LegAngles velocity_rad_s) const;

  /// Joint speeds for a speed of the sole point. Where |sin k| < 0.05 the inverse is damped, so
  /// that speeds stay bounded near the stretched leg instead of growing without end.
  LegAngles joint_velocity_rad_s(const LegPosture& p, PlaneVector velocity_m_s) const;
  LegAngles joint_velocity_rad_s(LegAngles q, PlaneVector velocity_m_s) const {
    return joint_velocity_rad_s(posture(q), velocity_m_s);
  }

  /// Joint accelerations: inverse Jacobian times (a - dJ/dt qdot), damped alike.
  LegAngles joint_acceleration_rad_s2(const LegPosture& p, LegAngles qdot_rad_s,
                                      PlaneVector acceleration_m_s2) const;
  LegAngles joint_acceleration_rad_s2(LegAngles q, LegAngles qdot_rad_s,
                                      PlaneVector acceleration_m_s2) const {
    return joint_acceleration_rad_s2(posture(q), qdot_rad_s, acceleration_m_s2);
  }

  /// Joint torques of a force on the sole point, J^T F.
  LegAngles joint_torque_Nm(LegAngles q, PlaneVector force_N) const;

  /// Force on the sole point that these joint torques (as J^T F) stand for; damped alike.
  PlaneVector foot_force_N(const LegPosture& p, LegAngles torque_Nm) const;
  PlaneVector foot_force_N(LegAngles q, LegAngles torque_Nm) const {
    return foot_force_N(posture(q), torque_Nm);
  }

  static float shank_angle_rad(LegAngles q) { return q.hip_rad + q.knee_rad; }

 private:
  PlaneVector foot_m(const LegSines& sines) const;
  float damped_inverse_determinant(const LegSines& sines) const;

  float l1_;
  float l2_;
};

}  // namespace hoof::firmware::control
