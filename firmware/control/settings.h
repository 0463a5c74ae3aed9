// All numbers of the controller that a person may tune, with their defaults. Names, ranges and
// descriptions for setting them from outside: firmware/app/parameters.h.
#pragma once

namespace hoof::firmware::control {

/// Units of planning per tick and generator (toe, leg): a plan is spread so that a tick of 1 ms on
/// the board holds it beside everything else. A toe's move then starts some 6 ticks after its
/// order, the leg's 12 (trajectory/planner.h); set points never wait for it, they go on as they
/// were.
inline constexpr int kPlanningUnitsPerTick = 1;

struct ToeSettings {
  /// 1.5 Nm of sand torque then turn the toe by 0.34 degrees; half a degree is asked for.
  float kp_Nm_rad = 250.0f;
  /// Damping ratio 0.7 on the inertia below: 2 * 0.7 * sqrt(250 * 0.012).
  float kd_Nm_s_rad = 2.4f;
  float inertia_kg_m2 = 0.012f;  // rotor, reflected, with both toes
  /// Drive of the AK80-9 class, at the joint: back-drive torque of its data sheet, and a tenth of
  /// that more at 2 rad/s. The same numbers as sim/config/drives/goat.toml, held by a test.
  float friction_Nm = 0.48f;
  float viscous_friction_Nm_s_rad = 0.024f;
  float speed_rad_s = 2.0f;
  float acceleration_rad_s2 = 20.0f;  // 0.24 Nm
  float jerk_rad_s3 = 1000.0f;
  float largest_angle_rad = 0.698132f;  // 40 degrees, the widest of the source paper
  /// A move that cannot be carried out: standing still so far behind the set point. With at least
  /// this torque, for this long, it is a jam; with less (weak gain, lost torque) a stall.
  float jam_torque_Nm = 4.0f;      // 2.7 times the sand's 1.5 Nm
  float jam_distance_rad = 0.05f;  // 3 degrees: a load of 12 Nm, beyond any that sand makes
  float jam_time_s = 0.2f;
  float stall_time_s = 0.5f;  // longer than a jam's: no torque presses on anything meanwhile
};

struct HomingSettings {
  float speed_rad_s = 0.5f;
  /// At the stop the drive pushes with speed * damping = 1.2 Nm. Apart from the toe's own damping
  /// so that tuning the one cannot break the other.
  float kd_Nm_s_rad = 2.4f;
  float stall_torque_Nm = 0.6f;     // half of the push: above friction (0.49 Nm), surely reached
  float stall_speed_rad_s = 0.06f;  // three codes of the reply's velocity
  float stall_time_s = 0.05f;
  float timeout_s = 5.0f;       // 1.5 rad at the 0.3 rad/s that friction leaves; the range is 1
  float stop_angle_rad = 0.0f;  // joint angle at the closed end stop
  /// Not 0: the toe drive tells its angle from power-on and is not sent to the stop.
  float absolute_encoder = 0.0f;
  float calibrated = 1.0f;  // 0: the zero of that encoder was never set; orders are refused

  bool is_absolute() const { return absolute_encoder != 0.0f; }
  bool is_calibrated() const { return calibrated != 0.0f; }
  bool operator==(const HomingSettings&) const = default;
};

struct LegSettings {
  /// 235 Nm of stance peak turn the hip by 0.016 rad: 8 mm at the foot.
  float kp_Nm_rad = 15000.0f;
  /// Damping ratio 0.7 for the whole leg (0.85 kg m2) about the hip: 2 * 0.7 * sqrt(15000 * 0.85).
  float kd_Nm_s_rad = 150.0f;
  /// Lets a loaded leg down in a damped stop: 200 Nm of load sink at 1 rad/s.
  float stop_kd_Nm_s_rad = 200.0f;
  float speed_rad_s = 1.0f;  // move to the start of the path
  float acceleration_rad_s2 = 5.0f;
  float jerk_rad_s3 = 50.0f;
  float calibrated = 1.0f;  // 0: the zeros of hip and knee were never set; orders are refused

  bool is_calibrated() const { return calibrated != 0.0f; }
};

/// The leg as rigid links; centres of mass lie on the lines hip - knee and knee - sole point.
struct LegModelSettings {
  float thigh_m = 0.3f;
  float shank_m = 0.3f;
  float thigh_mass_kg = 2.0f;
  float thigh_centre_m = 0.15f;
  float thigh_inertia_kg_m2 = 0.015f;  // slender rod: m l^2 / 12
  float shank_mass_kg = 1.0f;
  float shank_centre_m = 0.15f;
  float shank_inertia_kg_m2 = 0.0075f;
  float foot_mass_kg = 1.5f;  // source paper's data page: 1.0 to 2.1
  float foot_centre_m = 0.28f;
  /// Each drive, at the joint: rotor 3650 g cm2 on 26:1; Coulomb friction of 1.5 % of the peak
  /// torque, and viscous. The same numbers as sim/config/drives/goat.toml, held by a test.
  float rotor_inertia_kg_m2 = 0.24674f;
  float friction_Nm = 4.8f;
  float viscous_friction_Nm_s_rad = 0.5f;
};

struct PathSettings {
  float semi_x_m = 0.10f;
  float semi_z_m = 0.04f;
  float centre_above_sand_m = 0.005f;
  float hip_above_sand_m = 0.5f;
  float largest_frequency_Hz = 2.0f;  // the paper's fastest is 1.12
  /// Where every walk starts: the top, clear of the sand. Other legs of a gait start elsewhere in
  /// the upper half, 0.5 to 1.
  float start_phase_cycles = 0.75f;
};

struct ContactSettings {
  float filter_s = 0.01f;
  float touch_force_N = 25.0f;  // above what friction may feign, see ground_contact.h
  float release_force_N = 12.0f;
  float hold_s = 0.005f;
  /// Speed of the hip over ground, forward: 0 where the hip is held, as on the paper's rig.
  float body_speed_m_s = 0.0f;
  float slip_speed_m_s = 0.05f;  // ten codes of the leg's speeds; no slip ratio below
  float slip_filter_s = 0.02f;
};

/// Opening that follows the sand; off unless enabled. The source paper leaves it as future work, so
/// these numbers are choices: 10 mm deeper than the reference open by 0.1 rad, 6 degrees.
struct AdaptiveSettings {
  float enabled = 0.0f;  // not 0: on
  float gain_rad_m = 10.0f;
  float reference_sinkage_m = 0.01f;
  float largest_step_rad = 0.05f;  // per cycle; takes 0.15 s
  float deadband_m = 0.002f;       // sinkage differs so much from step to step on the same sand

  bool is_enabled() const { return enabled != 0.0f; }
};

struct StopSettings {
  float rest_speed_rad_s = 0.05f;
  float rest_time_s = 0.1f;
  float longest_s = 2.0f;  // then off, at rest or not
};

struct Settings {
  ToeSettings toe;
  HomingSettings homing;
  LegSettings leg;
  LegModelSettings leg_model;
  PathSettings path;
  ContactSettings contact;
  AdaptiveSettings adaptive;
  StopSettings stop;
};

}  // namespace hoof::firmware::control
