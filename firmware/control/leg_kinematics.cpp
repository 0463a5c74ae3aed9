#include "firmware/control/leg_kinematics.h"

#include <bit>
#include <cstdint>

namespace hoof::firmware::control {

namespace {

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace

PlaneVector LegKinematics::foot_m(const LegSines& sines) const {
  const auto& [h, s, k] = sines;
  return {l1_ * h.sin + l2_ * s.sin, -l1_ * h.cos - l2_ * s.cos};
}

LegPosture LegKinematics::posture(LegAngles q) const {
  const LegSines sines(q);
  const PlaneVector p = foot_m(sines);
  const LegJacobian jacobian{
      .x_h = -p.z, .x_k = l2_ * sines.s.cos, .z_h = p.x, .z_k = l2_ * sines.s.sin};
  return {q, sines, p, jacobian, damped_inverse_determinant(sines)};
}

void LegKinematics::update(LegPosture& posture, LegAngles q) const {
  const bool same =
      same_bits(posture.q.hip_rad, q.hip_rad) && same_bits(posture.q.knee_rad, q.knee_rad);
  if (!same) posture = this->posture(q);
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

PlaneVector LegKinematics::foot_velocity_m_s(const LegPosture& p, LegAngles v) const {
  const LegJacobian& j = p.jacobian;
  return {j.x_h * v.hip_rad + j.x_k * v.knee_rad, j.z_h * v.hip_rad + j.z_k * v.knee_rad};
}

/// det J = l1 l2 sin k. Near zero 1/det becomes det/(det^2 + d^2) (damped least squares), with d
/// growing from zero at the threshold so that the inverse is continuous.
float LegKinematics::damped_inverse_determinant(const LegSines& sines) const {
  const float determinant = l1_ * l2_ * sines.k.sin;
  const float threshold = 0.05f * l1_ * l2_;
  const float size = absolute(determinant);
  if (size >= threshold) return 1.0f / determinant;
  const float damping_squared = threshold * (threshold - size);
  return determinant / (determinant * determinant + damping_squared);
}

LegAngles LegKinematics::joint_velocity_rad_s(const LegPosture& p, PlaneVector v) const {
  const LegJacobian& j = p.jacobian;
  const float inverse = p.inverse_determinant;
  return {inverse * (j.z_k * v.x - j.x_k * v.z), inverse * (j.x_h * v.z - j.z_h * v.x)};
}

LegAngles LegKinematics::joint_acceleration_rad_s2(const LegPosture& p, LegAngles qdot,
                                                   PlaneVector a) const {
  const auto& [h, s, k] = p.sines;
  const float h2 = square(qdot.hip_rad);
  const float s2 = square(qdot.hip_rad + qdot.knee_rad);
  const PlaneVector centripetal{-l1_ * h.sin * h2 - l2_ * s.sin * s2,
                                l1_ * h.cos * h2 + l2_ * s.cos * s2};
  return joint_velocity_rad_s(p, {a.x - centripetal.x, a.z - centripetal.z});
}

LegAngles LegKinematics::joint_torque_Nm(LegAngles q, PlaneVector f) const {
  const LegJacobian j = jacobian(q);
  return {j.x_h * f.x + j.z_h * f.z, j.x_k * f.x + j.z_k * f.z};
}

PlaneVector LegKinematics::foot_force_N(const LegPosture& p, LegAngles torque) const {
  const LegJacobian& j = p.jacobian;
  const float inverse = p.inverse_determinant;
  return {inverse * (j.z_k * torque.hip_rad - j.z_h * torque.knee_rad),
          inverse * (j.x_h * torque.knee_rad - j.x_k * torque.hip_rad)};
}

}  // namespace hoof::firmware::control
