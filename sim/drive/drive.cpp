// Symbols, all at the joint side of the gear:
//   q, w       rotor position and velocity           J  rotor inertia        b  viscous friction
//   q_j, w_j   joint position and velocity           k  gear stiffness       F  Coulomb friction
//   tau        motor torque, held for one step       c  gear damping
#include "sim/drive/drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::sim {
namespace {

/// Sub-steps per call: h sqrt(k/J) stays below 0.01 for the stiffest drive shipped (toe: 713 rad/s
/// at 50 microseconds), so that the rotor's ringing is followed to 1e-4 of its period.
constexpr int kSubsteps = 10;

}  // namespace

Drive::Drive(const DriveSettings& settings, double joint_position_rad)
    : settings_(settings),
      count_rad_(2.0 * std::numbers::pi / (settings.encoder_counts_turn * settings.gear_ratio)),
      position_rad_(joint_position_rad),
      temperature_C_(settings.ambient_C),
      joint_position_rad_(joint_position_rad) {
  settings_.validate();
  if (!settings_.absolute_position) zero();
  sampled_position_rad_ = counted_position_rad_ = encoder_position_rad();
}

void Drive::add_physics(std::unique_ptr<JointEffect> effect) {
  physics_.add(std::move(effect), settings_.torque_limit_Nm);
  if (!settings_.absolute_position) zero();
  sampled_position_rad_ = counted_position_rad_ = encoder_position_rad();
}

void Drive::enable() {
  enabled_ = true;
  error_ = DriveError::kNone;
  late_commands_.clear();
  command_age_s_ = settings_.command_timeout_s;
}

void Drive::disable() {
  enabled_ = false;
  late_commands_.clear();
}

void Drive::zero() {
  zero_rad_ = physics_.reading_rad(position_rad_);
  sampled_position_rad_ = counted_position_rad_ = 0.0;
  sampled_velocity_rad_s_ = 0.0;
}

void Drive::restart() {
  disable();
  error_ = DriveError::kNone;
  command_ = {};
  command_age_s_ = settings_.command_timeout_s;
  if (!settings_.absolute_position) zero();
}

void Drive::command(const DriveCommand& command) {
  if (physics_.any()) {
    if (physics_.goal_lost()) return;
    if (physics_.goal_delay_s() > 0) {
      late_commands_.push_back({command, physics_.goal_delay_s()});
      return;
    }
  }
  command_ = command;
  command_age_s_ = 0.0;
}

/// Before a step: goals whose time has come count from its start on.
void Drive::take_late_commands(double dt_s) {
  constexpr double kRounding_s = 1e-9;
  while (!late_commands_.empty() && late_commands_.front().left_s < kRounding_s) {
    command_ = late_commands_.front().command;
    command_age_s_ = 0.0;
    late_commands_.pop_front();
  }
  for (LateCommand& late : late_commands_) late.left_s -= dt_s;
}

double Drive::encoder_position_rad() const {
  const double angle_rad = physics_.reading_rad(position_rad_) - zero_rad_;
  return std::floor(angle_rad / count_rad_ + 0.5) * count_rad_;
}

void Drive::sample_encoder(double dt_s) {
  double position = encoder_position_rad();
  for (DriveEffect* effect : effects_) position = effect->encoder_rad(position, dt_s);
  const double difference = (position - counted_position_rad_) / dt_s;
  if (dt_s != filter_dt_s_) {
    filter_dt_s_ = dt_s;
    filter_share_ = 1.0 - std::exp(-2.0 * std::numbers::pi * settings_.velocity_filter_Hz * dt_s);
  }
  sampled_velocity_rad_s_ += filter_share_ * (difference - sampled_velocity_rad_s_);
  counted_position_rad_ = sampled_position_rad_ = position;
  for (DriveEffect* effect : effects_) sampled_position_rad_ += effect->zero_shift_rad();
}

bool Drive::obeys() const {
  return enabled_ && command_age_s_ < settings_.command_timeout_s && error_ == DriveError::kNone;
}

bool Drive::passive(double torque_Nm, double velocity_rad_s) const {
  return !obeys() || (command_.kp_Nm_rad == 0.0 && std::abs(command_.torque_Nm) <= torque_Nm &&
                      std::abs(command_.velocity_rad_s) <= velocity_rad_s);
}

double Drive::law_torque_Nm() const {
  if (!obeys()) return 0.0;
  return command_.kp_Nm_rad * (command_.position_rad - sampled_position_rad_) +
         command_.kd_Nm_s_rad * (command_.velocity_rad_s - sampled_velocity_rad_s_) +
         command_.torque_Nm;
}

double Drive::limited_torque_Nm(double wanted_Nm) const {
  // Back-EMF takes from the voltage only while the motor drives its own motion; braking is limited
  // by current alone.
  const double along = wanted_Nm >= 0.0 ? velocity_rad_s_ : -velocity_rad_s_;
  const double line =
      settings_.stall_torque_Nm * (1.0 - std::max(along, 0.0) / settings_.no_load_speed_rad_s);
  const double limit = std::clamp(line, 0.0, settings_.torque_limit_Nm);
  return std::clamp(wanted_Nm, -limit, limit);
}

/// The rotor's sub-steps of one step, while the joint moves evenly from first_rad on. The state is
/// held in locals: this is where a plant without sand spends its time.
/// @return the mean torque of the gear on the joint
double Drive::swing(double h_s, double first_rad, double w_j) {
  const DriveSettings& s = settings_;
  const double J = s.rotor_inertia_kg_m2;
  const double k = physics_.stiffness_Nm_rad(s.gear_stiffness_Nm_rad);
  const double gear_c = k < s.gear_stiffness_Nm_rad
                            ? s.gear_damping_Nm_s_rad * std::sqrt(k / s.gear_stiffness_Nm_rad)
                            : s.gear_damping_Nm_s_rad;
  const double b = s.viscous_friction_Nm_s_rad;
  const double half_gap = physics_.half_gap_rad();
  double c = gear_c;
  double mass = J + h_s * (c + b);
  double most = h_s * s.coulomb_friction_Nm / mass;
  double position_rad = position_rad_;
  double start = velocity_rad_s_;
  DriveEnergy energy = energy_;
  double sum_Nm = 0.0;
  for (int i = 0; i < kSubsteps; ++i) {
    const double q_j = first_rad + w_j * h_s * i;
    const double twist = position_rad - q_j;
    const double stretch = twist - std::clamp(twist, -half_gap, half_gap);
    if (half_gap > 0.0) {  // in the play rotor and joint do not feel each other
      c = stretch == 0.0 ? 0.0 : gear_c;
      mass = J + h_s * (c + b);
      most = h_s * s.coulomb_friction_Nm / mass;
    }
    // Damping implicit, so that any c and b are stable. Coulomb friction as an impulse that brings
    // the rotor to rest at most: below it the rotor sticks exactly, above it slides against it.
    const double push = motor_torque_Nm_ - k * stretch + c * w_j;
    const double free = (J * start + h_s * push) / mass;
    if (!effects_.empty() || physics_.rubs()) most = h_s * coulomb_Nm(start, push) / mass;
    const double w = std::abs(free) <= most ? 0.0 : free - std::copysign(most, free);
    const double friction_Nm = b * w + (free - w) * mass / h_s;
    for (DriveEffect* effect : effects_) {
      effect->note_friction(friction_Nm - b * w, s.coulomb_friction_Nm);
    }

    // The gear's torque over the sub-step is what changed the rotor, not what the spring says at
    // one of its ends: momentum between rotor and joint is kept to the last bit.
    const double damper_Nm = c * (w - w_j);
    sum_Nm += k * stretch + damper_Nm;
    position_rad += h_s * w;

    const double mean = 0.5 * (start + w);
    energy.motor_J += motor_torque_Nm_ * mean * h_s;
    energy.friction_J += friction_Nm * mean * h_s;
    energy.gear_damping_J += damper_Nm * (mean - w_j) * h_s;
    start = w;
  }
  position_rad_ = position_rad;
  velocity_rad_s_ = start;
  energy_ = energy;
  return sum_Nm / kSubsteps;
}

/// @param push_Nm the way a rotor at rest is about to go
double Drive::coulomb_Nm(double velocity_rad_s, double push_Nm) const {
  double sum_Nm = settings_.coulomb_friction_Nm;
  for (const DriveEffect* effect : effects_) sum_Nm += effect->friction_Nm();
  if (!physics_.rubs()) return sum_Nm;
  const double w = velocity_rad_s != 0.0 ? velocity_rad_s : std::copysign(1e-12, push_Nm);
  const JointMotion motion{
      w,      motor_torque_Nm_, -joint_torque_Nm_, settings_.coulomb_friction_Nm, position_rad_,
      time_s_};
  return std::max(sum_Nm + physics_.friction_Nm(motion), 0.0);
}

void Drive::warm_up(double dt_s) {
  const double loss_W = settings_.copper_loss_W_Nm2 * asked_torque_Nm_ * asked_torque_Nm_;
  const double cooling_W =
      (temperature_C_ - settings_.ambient_C) / settings_.thermal_resistance_K_W;
  temperature_C_ += (loss_W - cooling_W) * dt_s / settings_.heat_capacity_J_K;
  if (temperature_C_ > settings_.temperature_limit_C) error_ = DriveError::kOverTemperature;
}

double Drive::step(double dt_s, double joint_position_rad, double joint_velocity_rad_s) {
  // The joint's work in the step before is known only now that its velocity after it is.
  energy_.joint_J += joint_torque_Nm_ * 0.5 * (joint_velocity_rad_s_ + joint_velocity_rad_s) * dt_s;
  joint_velocity_rad_s_ = joint_velocity_rad_s;

  sample_encoder(dt_s);
  take_late_commands(dt_s);
  asked_torque_Nm_ = limited_torque_Nm(law_torque_Nm());
  for (DriveEffect* effect : effects_) asked_torque_Nm_ = effect->motor_torque_Nm(asked_torque_Nm_);
  motor_torque_Nm_ = obeys() ? physics_.motor_torque_Nm(asked_torque_Nm_, velocity_rad_s_, dt_s)
                             : asked_torque_Nm_;
  command_age_s_ += dt_s;

  // The multibody side is a leapfrog: the torque of this step takes its velocity from half a step
  // before the given position to half a step after it. So the sub-steps, leapfrogs themselves, lie
  // evenly about that position; a shift by half a step would damp or drive the gear's own swing
  // with k dt / 2, a quarter of the toe's own damping.
  const double h_s = dt_s / kSubsteps;
  const double first_rad = joint_position_rad - 0.5 * (kSubsteps - 1) * h_s * joint_velocity_rad_s;
  joint_torque_Nm_ = swing(h_s, first_rad, joint_velocity_rad_s);
  joint_position_rad_ = first_rad + joint_velocity_rad_s * dt_s;
  warm_up(dt_s);
  const double link_Nm =
      physics_.any() ? physics_.link_torque_Nm(joint_position_rad, joint_velocity_rad_s, time_s_)
                     : 0.0;
  time_s_ += dt_s;
  return joint_torque_Nm_ + link_Nm;
}

DriveReading Drive::reading() const {
  return {sampled_position_rad_, sampled_velocity_rad_s_, asked_torque_Nm_, temperature_C_, error_};
}

DriveEnergy Drive::energy() const {
  DriveEnergy energy = energy_;
  const double twist = position_rad_ - joint_position_rad_;
  const double half_gap = physics_.half_gap_rad();
  const double stretch = twist - std::clamp(twist, -half_gap, half_gap);
  energy.kinetic_J = 0.5 * settings_.rotor_inertia_kg_m2 * velocity_rad_s_ * velocity_rad_s_;
  energy.spring_J =
      0.5 * physics_.stiffness_Nm_rad(settings_.gear_stiffness_Nm_rad) * stretch * stretch;
  return energy;
}

}  // namespace hoof::sim
