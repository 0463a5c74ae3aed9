#include "sim/drive/drive_settings.h"

#include <sstream>
#include <stdexcept>

namespace hoof::sim {
namespace {

void require(bool holds, const char* name, double value, const char* rule) {
  if (holds) return;
  std::ostringstream text;
  text << name << " = " << value << ": must be " << rule;
  throw std::invalid_argument(text.str());
}

}  // namespace

void DriveSettings::validate() const {
  const auto positive = [](double value, const char* name) {
    require(value > 0.0, name, value, "above 0");
  };
  const auto not_negative = [](double value, const char* name) {
    require(value >= 0.0, name, value, "at least 0");
  };
  positive(gear_ratio, "gear_ratio");
  positive(rotor_inertia_kg_m2, "rotor_inertia_kg_m2");
  positive(torque_limit_Nm, "torque_limit_Nm");
  require(stall_torque_Nm >= torque_limit_Nm, "stall_torque_Nm", stall_torque_Nm,
          "at least torque_limit_Nm");
  positive(no_load_speed_rad_s, "no_load_speed_rad_s");
  positive(gear_stiffness_Nm_rad, "gear_stiffness_Nm_rad");
  not_negative(gear_damping_Nm_s_rad, "gear_damping_Nm_s_rad");
  not_negative(coulomb_friction_Nm, "coulomb_friction_Nm");
  not_negative(viscous_friction_Nm_s_rad, "viscous_friction_Nm_s_rad");
  positive(encoder_counts_turn, "encoder_counts_turn");
  positive(velocity_filter_Hz, "velocity_filter_Hz");
  positive(command_timeout_s, "command_timeout_s");
  not_negative(copper_loss_W_Nm2, "copper_loss_W_Nm2");
  positive(thermal_resistance_K_W, "thermal_resistance_K_W");
  positive(heat_capacity_J_K, "heat_capacity_J_K");
  require(temperature_limit_C > ambient_C, "temperature_limit_C", temperature_limit_C,
          "above ambient_C");
}

DriveSettings read_drive(Reader section) {
  DriveSettings drive;
  section.number("gear_ratio", drive.gear_ratio, kUnitless, 1.0, 1000.0);
  section.number("rotor_inertia_g_cm2", drive.rotor_inertia_kg_m2, kGramSquareCentimetre, 0.1, 1e6);
  drive.rotor_inertia_kg_m2 *= drive.gear_ratio * drive.gear_ratio;
  section.number("joint_torque_limit_Nm", drive.torque_limit_Nm, kNewtonMetre, 0.01, 2000.0);
  section.number("joint_stall_torque_Nm", drive.stall_torque_Nm, kNewtonMetre, 0.01, 20000.0);
  section.number("joint_no_load_speed_rpm", drive.no_load_speed_rad_s, kRevolutionPerMinute, 1.0,
                 20000.0);
  section.number("gear_stiffness_Nm_rad", drive.gear_stiffness_Nm_rad, kNewtonMetrePerRadian, 1.0,
                 1e6);
  section.number("gear_damping_Nm_s_rad", drive.gear_damping_Nm_s_rad, kNewtonMetreSecondPerRadian,
                 0.0, 1e3);
  section.number("coulomb_friction_Nm", drive.coulomb_friction_Nm, kNewtonMetre, 0.0, 100.0);
  section.number("viscous_friction_Nm_s_rad", drive.viscous_friction_Nm_s_rad,
                 kNewtonMetreSecondPerRadian, 0.0, 100.0);
  section.number("encoder_counts_turn", drive.encoder_counts_turn, kUnitless, 16.0, 1e8);
  section.number("velocity_filter_Hz", drive.velocity_filter_Hz, kHertz, 1.0, 1e4);
  section.flag("absolute_position", drive.absolute_position);
  section.number("command_timeout_ms", drive.command_timeout_s, kMillisecond, 1.0, 1000.0);
  section.number("copper_loss_W_Nm2", drive.copper_loss_W_Nm2, kWattPerSquareNewtonMetre, 0.0,
                 100.0);
  section.number("thermal_resistance_K_W", drive.thermal_resistance_K_W, kKelvinPerWatt, 0.01,
                 100.0);
  section.number("heat_capacity_J_K", drive.heat_capacity_J_K, kJoulePerKelvin, 0.1, 1e5);
  section.number("ambient_C", drive.ambient_C, kCelsius, -40.0, 60.0);
  section.number("temperature_limit_C", drive.temperature_limit_C, kCelsius, 40.0, 200.0);
  section.finish();
  section.check([&drive] { drive.validate(); });
  return drive;
}

}  // namespace hoof::sim
