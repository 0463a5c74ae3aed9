#include "firmware/control/leg_dynamics.h"

namespace hoof::firmware::control {

LegDynamics::LegDynamics(const LegModelSettings& m)
    : a_(m.thigh_inertia_kg_m2 + m.thigh_mass_kg * square(m.thigh_centre_m) +
         (m.shank_mass_kg + m.foot_mass_kg) * square(m.thigh_m)),
      b_(m.shank_inertia_kg_m2 + m.shank_mass_kg * square(m.shank_centre_m) +
         m.foot_mass_kg * square(m.foot_centre_m)),
      c_((m.shank_mass_kg * m.shank_centre_m + m.foot_mass_kg * m.foot_centre_m) * m.thigh_m),
      moment_h_(m.thigh_mass_kg * m.thigh_centre_m +
                (m.shank_mass_kg + m.foot_mass_kg) * m.thigh_m),
      moment_s_(m.shank_mass_kg * m.shank_centre_m + m.foot_mass_kg * m.foot_centre_m),
      rotor_(m.rotor_inertia_kg_m2),
      friction_(m.friction_Nm),
      viscous_(m.viscous_friction_Nm_s_rad) {}

// With absolute angles h and s = h + k:
//   T = A h'^2/2 + B s'^2/2 + C cos(s - h) h' s',   V = -g (m_h cos h + m_s cos s)
//   Q_h = A h'' + C cos(k) s'' - C sin(k) s'^2 + g m_h sin h
//   Q_s = B s'' + C cos(k) h'' + C sin(k) h'^2 + g m_s sin s
// The hip torque turns both links (Q_h + Q_s), the knee torque only the shank (Q_s).
LegAngles LegDynamics::torque_Nm(const LegSines& q, LegAngles v, LegAngles a) const {
  const auto& [h, s, k] = q;
  const float s_dot = v.hip_rad + v.knee_rad;
  const float s_ddot = a.hip_rad + a.knee_rad;
  const float q_h = a_ * a.hip_rad + c_ * k.cos * s_ddot - c_ * k.sin * square(s_dot) +
                    kGravity_m_s2 * moment_h_ * h.sin;
  const float q_s = b_ * s_ddot + c_ * k.cos * a.hip_rad + c_ * k.sin * square(v.hip_rad) +
                    kGravity_m_s2 * moment_s_ * s.sin;
  return {q_h + q_s + rotor_ * a.hip_rad + smooth_friction_Nm(friction_, viscous_, v.hip_rad),
          q_s + rotor_ * a.knee_rad + smooth_friction_Nm(friction_, viscous_, v.knee_rad)};
}

LegAngles LegDynamics::friction_doubt_Nm(LegAngles v) const {
  return {smooth_friction_doubt_Nm(friction_, v.hip_rad),
          smooth_friction_doubt_Nm(friction_, v.knee_rad)};
}

}  // namespace hoof::firmware::control
