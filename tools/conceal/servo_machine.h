#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "tools/conceal/goal_path.h"
#include "tools/conceal/hidden_effect.h"

namespace hoof::tools::conceal {

enum class DriveLaw { kImpedance, kDuty, kTorque };

/// The machine without anything hidden: what the contract's rig servo_pendulum has in [setup].
struct ServoMachine {
  DriveLaw law = DriveLaw::kImpedance;
  double payload_mass_kg = 0.5, payload_length_m = 0.1, arm_mass_kg = 0.02;
  double armature_kgm2 = 0.002, gravity_m_s2 = 9.81;
  double coulomb_Nm = 0.03, viscous_Nms_rad = 0.01;
  double control_period_s = 0.001;
  double kt_Nm_A = 0.35, resistance_ohm = 3.4, supply_V = 7.4, counts_per_rad = 651.8986;
  double kd_Nms_rad = 0.1, torque_limit_Nm = 10.0;

  double link_inertia_kgm2() const;
  double inertia_kgm2() const { return link_inertia_kgm2() + armature_kgm2; }
  /// g l (m + m_a / 2): the torque of gravity with the link held level.
  double gravity_torque_Nm() const;
};

/// What is done with the machine in one recording.
struct ServoExercise {
  GoalPath goal;      ///< of the position, or of the torque under DriveLaw::kTorque
  double gain = 0.0;  ///< kp of the impedance law, kp_duty of the duty law
  bool velocity_goal = false;
  /// Feed-forward torque as the operator's model has it, off where all are zero.
  double feed_gravity_Nm = 0.0, feed_inertia_kgm2 = 0.0;
  double disable_at_s = std::numeric_limits<double>::infinity();  ///< enable = 0 from there on
  GoalPath supply_wander;       ///< V, added to the machine's supply
  std::vector<double> times_s;  ///< of the samples, from 0 on
  /// The path began this long before the first sample.
  double lead_in_s = 0.0;
  std::uint64_t loss_seed = 0;    ///< which goals are lost, where some are
  double encoder_step_rad = 0.0;  ///< of the drive's own encoder, 0 = very fine
};

/// All channels without recorder's noise, one value per sample.
struct ServoSignals {
  std::vector<double> position_goal, velocity_goal, torque_ff, enable, supply_voltage;
  std::vector<double> position, velocity, current, torque;
  std::vector<std::vector<double>> influence;  ///< one row per hidden effect: its own strength
  double square_current_mean = 0.0;            ///< A^2, over the samples
  double fourth_current_mean = 0.0;            ///< A^4
  double square_heat_mean = 0.0;  ///< of the heating state, with the current's rms still in A
  bool sane = true;               ///< false where the motion ran away or turned over the top
};

/// Torque that the exercise feeds forward at a time of its path, by the operator's own model.
double feed_forward(const ServoExercise& exercise, double t_s);

struct ServoStart {
  bool given = false;  ///< else at rest where the path begins, settled for a second
  double position_rad = 0.0, velocity_rad_s = 0.0;
};

/// Runs one exercise: classical Runge-Kutta in steps of at most `step_s`; the sign of friction is
/// fixed within a step, a reversal is found inside it, and at rest friction holds what it can.
ServoSignals run_servo(const ServoMachine& machine, const std::vector<HiddenEffect>& hidden,
                       const ServoExercise& exercise, const ServoStart& start = {},
                       double step_s = 1e-4);

}  // namespace hoof::tools::conceal
