// A back-drivable geared joint drive: its electronics, its motor and its gear.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "sim/drive/drive_settings.h"
#include "sim/drive/joint_physics.h"
#include "sim/effects/drive_effect.h"

namespace hoof::sim {

/// One command of the drive's position-velocity-torque law, at the joint side of the gear:
/// tau = kp (position - p) + kd (velocity - v) + torque.
struct DriveCommand {
  double position_rad = 0.0;
  double velocity_rad_s = 0.0;
  double kp_Nm_rad = 0.0;
  double kd_Nm_s_rad = 0.0;
  double torque_Nm = 0.0;
};

enum class DriveError : std::uint8_t { kNone = 0, kOverTemperature = 1 };

/// What the drive's electronics know, at the joint side of the gear.
struct DriveReading {
  /// Motor encoder over gear ratio, counted from the drive's zero.
  double position_rad = 0.0;
  /// Filtered difference of the encoder.
  double velocity_rad_s = 0.0;
  /// From the motor current: torque of the motor before friction and gear.
  double torque_Nm = 0.0;
  double temperature_C = 0.0;
  DriveError error = DriveError::kNone;
};

/// Where the energy of a drive went since its start, J. Balance: motor = kinetic + spring +
/// friction + gear_damping + joint.
struct DriveEnergy {
  /// Work of the motor torque on the rotor.
  double motor_J = 0.0;
  /// Work of the gear on the joint, up to the start of the last step.
  double joint_J = 0.0;
  double friction_J = 0.0;
  double gear_damping_J = 0.0;
  /// Stored now.
  double kinetic_J = 0.0;
  double spring_J = 0.0;
};

/// Rotor inertia J (reflected to the joint), gear spring k and damper c between rotor and joint,
/// Coulomb and viscous friction on the rotor:
///   J dw/dt = tau_motor - b w - F sign(w) - k (q - q_joint) - c (w - w_joint).
/// The law runs once per step() on the encoder, and its torque is held for the whole step: call
/// step() at the drive's own rate of 20 kHz (every 50 microseconds).
class Drive {
 public:
  /// @param joint_position_rad where the joint stands when the drive gets its supply; the gear
  ///        starts relaxed
  /// @throws std::invalid_argument for settings that validate() refuses
  explicit Drive(const DriveSettings& settings, double joint_position_rad = 0.0);

  /// Enter and exit of the motor mode. A disabled drive is an open circuit: no motor torque, the
  /// joint feels rotor, friction and gear. Enabling clears an error and starts without a command.
  void enable();
  void disable();
  bool enabled() const { return enabled_; }

  /// The supply was gone and is back: disabled, without error or command. A drive without an
  /// absolute encoder counts from where it wakes up.
  void restart();

  /// Something that is wrong with this drive from its start() on; it must outlive the drive.
  void add_effect(DriveEffect& effect) { effects_.push_back(&effect); }

  /// Optional physics of this drive and its joint (joint_physics.h), before its first step.
  /// @throws std::invalid_argument for an effect that a drive of the foot has no place for
  void add_physics(std::unique_ptr<JointEffect> effect);

  /// True while the drive cannot push by itself: off, without a fresh command, or damping only. A
  /// feed-forward of no more than `torque_Nm` and a speed target of no more than `velocity_rad_s`
  /// count as none: the wire has no code for zero.
  bool passive(double torque_Nm, double velocity_rad_s) const;

  /// Makes the present encoder position the zero of commands and readings.
  void zero();

  /// Takes a new command. The torque ends settings.command_timeout_s after the last one. Effects
  /// of the bus on goals act here and not at the frame: no other order comes this way, replies tell
  /// the drive's state whether or not a goal counts, and the times are the same, as frames are
  /// handed on in plant time between two steps.
  void command(const DriveCommand& command);

  /// Advances by dt_s while the joint moves from joint_position_rad with joint_velocity_rad_s.
  /// @returns the mean torque on the joint, Nm: of the gear, and of effects that act on the link
  double step(double dt_s, double joint_position_rad, double joint_velocity_rad_s);

  DriveReading reading() const;
  DriveEnergy energy() const;

  /// True state, not known to the electronics; joint side.
  double rotor_position_rad() const { return position_rad_; }
  double rotor_velocity_rad_s() const { return velocity_rad_s_; }
  double motor_torque_Nm() const { return motor_torque_Nm_; }
  const DriveSettings& settings() const { return settings_; }

 private:
  double encoder_position_rad() const;
  bool obeys() const;
  void sample_encoder(double dt_s);
  double law_torque_Nm() const;
  double limited_torque_Nm(double wanted_Nm) const;
  double swing(double h_s, double first_rad, double joint_velocity_rad_s);
  double coulomb_Nm(double velocity_rad_s, double push_Nm) const;
  void take_late_commands(double dt_s);
  void warm_up(double dt_s);

  DriveSettings settings_;
  double count_rad_;  // of the encoder, at the joint
  DriveCommand command_;
  struct LateCommand {
    DriveCommand command;
    double left_s = 0;  // until it counts
  };
  std::deque<LateCommand> late_commands_;  // goals on their way, by effects
  bool enabled_ = false;
  DriveError error_ = DriveError::kNone;
  double command_age_s_ = 0.0;

  double position_rad_;
  double velocity_rad_s_ = 0.0;
  double zero_rad_ = 0.0;
  std::vector<DriveEffect*> effects_;
  JointPhysics physics_;
  double time_s_ = 0.0;                // since the first step; for effects
  double counted_position_rad_ = 0.0;  // what speed is the difference of
  double sampled_position_rad_ = 0.0;  // that, and what shifts the zero
  double sampled_velocity_rad_s_ = 0.0;
  double filter_dt_s_ = 0.0;  // step for which the speed filter takes filter_share_ of what is new
  double filter_share_ = 0.0;
  double asked_torque_Nm_ = 0.0;  // what the electronics take the motor's torque for
  double motor_torque_Nm_ = 0.0;
  double temperature_C_;
  /// Joint as of the last step, and the mean gear torque in it.
  double joint_position_rad_;
  double joint_velocity_rad_s_ = 0.0;
  double joint_torque_Nm_ = 0.0;
  DriveEnergy energy_;
};

}  // namespace hoof::sim
