// All numbers of the controller that a person may tune, with their defaults. Names, ranges and
// descriptions for setting them from outside: firmware/app/parameters.h.
#pragma once

namespace hoof::firmware::control {

struct ToeSettings {
  /// 1.5 Nm of sand torque then turn the toe by 0.34 degrees; half a degree is asked for.
  float kp_Nm_rad = 250.0f;
  /// Damping ratio 0.7 on the inertia below: 2 * 0.7 * sqrt(250 * 0.012).
  float kd_Nm_s_rad = 2.4f;
  float inertia_kg_m2 = 0.012f;  // rotor, reflected, with both toes
  float friction_Nm = 0.05f;
  float speed_rad_s = 2.0f;
  float acceleration_rad_s2 = 20.0f;  // 0.24 Nm
  float jerk_rad_s3 = 1000.0f;
  float largest_angle_rad = 0.698132f;  // 40 degrees, the widest of the source paper
  /// A jam: at least this torque, standing still so far from the target, for this long.
  float jam_torque_Nm = 4.0f;      // 2.7 times the sand's 1.5 Nm
  float jam_distance_rad = 0.05f;  // 3 degrees: a load of 12 Nm, beyond any that sand makes
  float jam_time_s = 0.2f;
};

struct HomingSettings {
  float speed_rad_s = 0.5f;
  /// At the stop the drive pushes with speed * damping = 1.2 Nm. Apart from the toe's own damping
  /// so that tuning the one cannot break the other.
  float kd_Nm_s_rad = 2.4f;
  float stall_torque_Nm = 0.6f;     // half of the push: far above friction, surely reached
  float stall_speed_rad_s = 0.06f;  // three codes of the reply's velocity
  float stall_time_s = 0.05f;
  float timeout_s = 5.0f;       // 2.5 rad of travel: three times the whole range
  float stop_angle_rad = 0.0f;  // joint angle at the closed end stop
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
  float rotor_inertia_kg_m2 = 0.12f;  // each drive, reflected
  float friction_Nm = 2.0f;           // each drive
};

struct PathSettings {
  float semi_x_m = 0.10f;
  float semi_z_m = 0.04f;
  float centre_above_sand_m = 0.005f;
  float hip_above_sand_m = 0.5f;
  float largest_frequency_Hz = 2.0f;  // the paper's fastest is 1.12
};

struct ContactSettings {
  float filter_s = 0.01f;
  float touch_force_N = 25.0f;  // friction of 2 Nm per joint reads as up to 10 N at the foot
  float release_force_N = 12.0f;
  float hold_s = 0.005f;
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
  StopSettings stop;
};

}  // namespace hoof::firmware::control
