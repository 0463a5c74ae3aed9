// A position-controlled geared motor carrying a link in gravity, driven by recorded inputs.
//
//   (m l^2 + m_a l^2/3 + J_a) dw/dt = tau_motor - friction(w) - g l (m + m_a/2) sin(q)
// with friction = coulomb sign(w) + viscous w, holding any net torque up to coulomb at rest.
// Effects of gap or compliance split the inertia: J_a and the friction on the motor's side, where
// the encoder is; the rest on the link's. Zero angle hangs straight down.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/effects/joint_effect.h"

namespace hoof::sim {

/// Of the duty law: duty = kp_duty counts_per_rad error / this.
inline constexpr double kDutyCounts = 256.0 * 885.0;

enum class PendulumLaw {
  kDuty,       // duty = kp_duty counts_per_rad error / kDutyCounts; voltage = duty supply
  kImpedance,  // torque = kp error + kd speed error + torque_ff, clipped
  kTorque,     // torque is an input
};

struct PendulumSettings {
  PendulumLaw law = PendulumLaw::kImpedance;
  double payload_mass_kg = 0;
  double payload_length_m = 0;
  double arm_mass_kg = 0;  // a uniform rod as long as the payload is far
  double armature_kg_m2 = 0;
  double gravity_m_s2 = 9.81;
  double coulomb_Nm = 0;
  double viscous_Nm_s_rad = 0;
  /// Inputs act this much after the time that the recording gives them; may be negative.
  double input_late_s = 0;
  double switch_late_s = 0;  // the drive turns on and off this much after the middle of two samples
  double control_period_s = 0;  // 0: the law is evaluated at each step

  double kp_duty = 0;
  double counts_per_rad = 0;
  double supply_V = 0;  // where no channel
  double kt_Nm_A = 0;
  double resistance_ohm = 0;

  double kp_Nm_rad = 0;
  double kd_Nm_s_rad = 0;
  double torque_limit_Nm = 0;

  double link_inertia_kg_m2() const;
  double gravity_torque_Nm() const;  // g l (m + m_a/2)
};

/// Of a path between two samples, less the slope of the line through both.
struct SlopeOffset {
  double start = 0, end = 0;
};

/// No goal arrives at evaluations of the law from the first time on and before the second.
struct LostGoals {
  double from_s = 0, until_s = 0;
};

/// Of one recording; an empty span is a channel that was not recorded. All as long as time_s.
struct PendulumInputs {
  std::span<const double> time_s;
  std::span<const double> position_goal_rad;
  std::span<const double> velocity_goal_rad_s;
  std::span<const double> torque_ff_Nm;
  std::span<const double> enable;
  std::span<const double> supply_V;
  std::span<const double> torque_Nm;  // of the law kTorque

  /// Of goals between a sample and the next: a cubic whose slopes at both ends are off by so much
  /// from the straight line's; empty: linear.
  std::span<const SlopeOffset> position_goal_bend_rad_s;
  std::span<const SlopeOffset> velocity_goal_bend_rad_s2;
  std::span<const SlopeOffset> torque_ff_bend_Nm_s;

  /// Where known: when the drive went without a new goal, in order; empty: all arrived.
  std::span<const LostGoals> lost;

  /// Measured, for corrections only.
  std::span<const double> position_rad;
};

/// How the state is drawn to the measured position at each sample: encoder angle and speed change
/// by these times the difference. Zero: a free rollout.
struct PendulumCorrection {
  double angle = 0;
  double speed_1_s = 0;
};

struct PendulumStart {
  double position_rad = 0;    // as the encoder reads it
  double velocity_rad_s = 0;  // likewise
  double current_rms_A = 0;   // over the data: what effects of heat are scaled by
  double torque_rms_Nm = 0;
};

struct PendulumTrace {
  std::vector<double> position_rad, velocity_rad_s, torque_Nm, current_A;  // one value per sample
  /// Size of the torques of effects at motor, friction and link, in sum.
  std::vector<double> effect_Nm;
};

/// Predicted channels at the times of the samples. `torque_Nm` is what the law commands
/// (kImpedance) or what the motor makes (kDuty); `current_A` is that torque over kt.
/// @param effects in the order in which they act; their state is reset
/// @param longest_step_s of the integration; halved and less where a gear swings
void simulate_pendulum(const PendulumSettings& settings, const PendulumInputs& inputs,
                       std::span<JointEffect* const> effects, const PendulumStart& start,
                       const PendulumCorrection& correction, double longest_step_s,
                       PendulumTrace& trace);

}  // namespace hoof::sim
