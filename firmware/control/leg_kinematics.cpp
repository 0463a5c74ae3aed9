#include "firmware/control/leg_kinematics.h"

namespace hoof::firmware::control {

PlaneVector LegKinematics::foot_m(LegAngles q) const {
  const SinCos h = sin_cos(q.hip_rad);
  const SinCos s = sin_cos(shank_angle_rad(q));
  return {l1_ * h.sin + l2_ * s.sin, -l1_ * h.cos - l2_ * s.cos};
}

LegInverse LegKinematics::angles(PlaneVector foot) const {
  const float shortest = absolute(l1_ - l2_) + 0.01f * (l1_ + l2_);
  const float longest = 0.999f * (l1_ + l2_);
  const float distance = square_root(square(foot.x) + square(foot.z));
  const float r = clamp(distance, shortest, longest);
  // Law of cosines; the knee bends backwards.
  const float cos_k = (r * r - l1_ * l1_ - l2_ * l2_) / (2.0f * l1_ * l2_);
  const float k = -acos(cos_k);
  const SinCos knee = sin_cos(k);
  const float h = atan2(foot.x, -foot.z) - atan2(l2_ * knee.sin, l1_ + l2_ * knee.cos);
  return {{h, k}, distance == r};
}

LegJacobian LegKinematics::jacobian(LegAngles q) const {
  const PlaneVector p = foot_m(q);
  const SinCos s = sin_cos(shank_angle_rad(q));
  return {.x_h = -p.z, .x_k = l2_ * s.cos, .z_h = p.x, .z_k = l2_ * s.sin};
}

PlaneVector LegKinematics::foot_velocity_m_s(LegAngles q, LegAngles v) const {
  const LegJacobian j = jacobian(q);
  return {j.x_h * v.hip_rad + j.x_k * v.knee_rad, j.z_h * v.hip_rad + j.z_k * v.knee_rad};
}

/// det J = l1 l2 sin k. Near zero 1/det becomes det/(det^2 + d^2) (damped least squares), with d
/// growing from zero at the threshold so that the inverse is continuous.
float LegKinematics::damped_inverse_determinant(LegAngles q) const {
  const float determinant = l1_ * l2_ * sin_cos(q.knee_rad).sin;
  const float threshold = 0.05f * l1_ * l2_;
  const float size = absolute(determinant);
  if (size >= threshold) return 1.0f / determinant;
  const float damping_squared = threshold * (threshold - size);
  return determinant / (determinant * determinant + damping_squared);
}

LegAngles LegKinematics::joint_velocity_rad_s(LegAngles q, PlaneVector v) const {
  const LegJacobian j = jacobian(q);
  const float inverse = damped_inverse_determinant(q);
  return {inverse * (j.z_k * v.x - j.x_k * v.z), inverse * (j.x_h * v.z - j.z_h * v.x)};
}

LegAngles LegKinematics::joint_acceleration_rad_s2(LegAngles q, LegAngles qdot,
                                                   PlaneVector a) const {
  const SinCos h = sin_cos(q.hip_rad);
  const SinCos s = sin_cos(shank_angle_rad(q));
  const float h2 = square(qdot.hip_rad);
  const float s2 = square(qdot.hip_rad + qdot.knee_rad);
  const PlaneVector centripetal{-l1_ * h.sin * h2 - l2_ * s.sin * s2,
                                l1_ * h.cos * h2 + l2_ * s.cos * s2};
  return joint_velocity_rad_s(q, {a.x - centripetal.x, a.z - centripetal.z});
}

LegAngles LegKinematics::joint_torque_Nm(LegAngles q, PlaneVector f) const {
  const LegJacobian j = jacobian(q);
  return {j.x_h * f.x + j.z_h * f.z, j.x_k * f.x + j.z_k * f.z};
}

PlaneVector LegKinematics::foot_force_N(LegAngles q, LegAngles torque) const {
  const LegJacobian j = jacobian(q);
  const float inverse = damped_inverse_determinant(q);
  return {inverse * (j.z_k * torque.hip_rad - j.z_h * torque.knee_rad),
          inverse * (j.x_h * torque.knee_rad - j.x_k * torque.hip_rad)};
}

}  // namespace hoof::firmware::control
