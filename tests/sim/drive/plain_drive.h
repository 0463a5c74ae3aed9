// A drive of round numbers for closed forms.
#pragma once

#include "sim/drive/drive.h"

namespace hoof::tests {

/// Friction, time-out, speed line and heat switched off where a case does not need them.
inline sim::DriveSettings plain_drive() {
  sim::DriveSettings s;
  s.gear_ratio = 10.0;
  s.rotor_inertia_kg_m2 = 0.01;
  s.torque_limit_Nm = 20.0;
  s.stall_torque_Nm = 1e9;
  s.no_load_speed_rad_s = 1e6;
  s.gear_stiffness_Nm_rad = 2000.0;
  s.gear_damping_Nm_s_rad = 0.0;
  s.encoder_counts_turn = 16384.0;
  s.velocity_filter_Hz = 200.0;
  s.absolute_position = true;
  s.command_timeout_s = 1e9;
  s.thermal_resistance_K_W = 3.0;
  s.heat_capacity_J_K = 100.0;
  s.ambient_C = 25.0;
  s.temperature_limit_C = 100.0;
  return s;
}

inline sim::DriveCommand torque_command(double torque_Nm) {
  sim::DriveCommand command;
  command.torque_Nm = torque_Nm;
  return command;
}

}  // namespace hoof::tests
