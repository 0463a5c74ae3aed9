// The numbers of one drive.
#pragma once

#include "sim/config/reader.h"

namespace hoof::sim {

/// All torques, speeds and stiffnesses at the joint side of the gear; motor values are converted by
/// read_drive() (torque times ratio, speed over ratio, inertia times ratio squared).
struct DriveSettings {
  double gear_ratio = 0.0;
  /// Rotor inertia times the gear ratio squared.
  double rotor_inertia_kg_m2 = 0.0;
  /// Clip of the drive's electronics (current limit).
  double torque_limit_Nm = 0.0;
  /// Speed-torque line at full voltage: torque falls from stall to zero at the no-load speed.
  double stall_torque_Nm = 0.0;
  double no_load_speed_rad_s = 0.0;
  double gear_stiffness_Nm_rad = 0.0;
  double gear_damping_Nm_s_rad = 0.0;
  double coulomb_friction_Nm = 0.0;
  double viscous_friction_Nm_s_rad = 0.0;
  /// Encoder on the motor shaft, counts per motor turn.
  double encoder_counts_turn = 0.0;
  /// Corner frequency of the low-pass on the encoder's difference.
  double velocity_filter_Hz = 0.0;
  /// True: a second encoder gives the joint position at power-on. False: the drive counts from
  /// where it woke up, and has to be homed.
  bool absolute_position = false;
  /// The drive drops its torque this long after the last command.
  double command_timeout_s = 0.0;
  /// Copper loss over torque squared.
  double copper_loss_W_Nm2 = 0.0;
  double thermal_resistance_K_W = 0.0;
  double heat_capacity_J_K = 0.0;
  double ambient_C = 0.0;
  double temperature_limit_C = 0.0;

  /// @throws std::invalid_argument naming the first broken rule: name, value, bound
  void validate() const;
};

/// Reads one drive, e.g. the section "drives.toe".
DriveSettings read_drive(Reader section);

}  // namespace hoof::sim
