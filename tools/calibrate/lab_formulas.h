// Closed forms of the single-grain laboratories: what the tests hold the simulation to, and the
// paper's own balances, which the reports print beside it.
//
// Symbol   Meaning                                                              Unit
// theta    incline to the horizontal                                            rad
// S1       way rolled along the incline, from rest                              m
// H4       height of the edge over the ground                                   m
// S2       horizontal travel from the edge to the ground                        m
// mu_r     rolling friction: torque over (normal force times radius)            1
// c        moment of inertia over m R^2: 2/5 of a solid sphere                  1
// v_3      speed at the edge                                                    m/s
//
// Rolling down without slip, the friction force f and the torque mu_r m g cos(theta) R:
//   m a = m g sin(theta) - f,   c m R^2 (a/R) = f R - mu_r m g cos(theta) R,  hence
//   a = g (sin(theta) - mu_r cos(theta)) / (1 + c),   v_3^2 = 2 a S1.
// The source paper (Ji et al., Actuators 2026, 15(6), 330) writes the balance without the spin
// energy, c = 0: its v_3^2 is 7/5 of this.
#pragma once

namespace hoof::tools {

inline constexpr double kGravity_m_s2 = 9.81;
inline constexpr double kSolidSphere = 0.4;  // c

/// Acceleration down an incline, m/s^2; 0 where rolling friction holds the grain.
/// @param inertia c; 0: the paper's balance
double rolling_acceleration_m_s2(double theta_rad, double mu_r, double inertia = kSolidSphere);

/// Least Coulomb coefficient at which a sphere rolls without slipping: its friction force is
/// f = m g (c sin + mu_r cos) / (1 + c).
double friction_to_roll(double theta_rad, double mu_r);

/// Horizontal travel of a body thrown with (vx, vz), vz upward, until `fall_m` below, m.
double flight_travel_m(double vx_m_s, double vz_m_s, double fall_m);

/// S2 of the rolling laboratory, m.
double roll_travel_m(double theta_rad, double run_m, double fall_m, double mu_r,
                     double inertia = kSolidSphere);

/// Rolling friction that gives the travel, between 0 and tan(theta).
/// @throws std::invalid_argument where none does
double rolling_friction_of(double travel_m, double theta_rad, double run_m, double fall_m,
                           double inertia = kSolidSphere);

}  // namespace hoof::tools
