// The torques of the servo pendulum and their sum: equations of the contract's rig servo_pendulum,
// and of everything that may be hidden in it.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/conceal/servo_plant.h"

namespace hoof::tools::conceal {
namespace {

double square(double x) {
  return x * x;
}

/// 0 before `at_s`, 1 a fifth of a second later: nothing real moves at once.
double gradual(double t_s, double at_s) {
  return std::clamp((t_s - at_s) / 0.2, 0.0, 1.0);
}

}  // namespace

double ServoMachine::link_inertia_kgm2() const {
  return (payload_mass_kg + arm_mass_kg / 3.0) * square(payload_length_m);
}

double ServoMachine::gravity_torque_Nm() const {
  return gravity_m_s2 * payload_length_m * (payload_mass_kg + 0.5 * arm_mass_kg);
}

double ServoPlant::payload_inertia(double t_s) const {
  const double length = machine_.payload_length_m + terms_.slide_by * gradual(t_s, terms_.slide_at);
  const double mass = machine_.payload_mass_kg - terms_.drop_by * gradual(t_s, terms_.drop_at);
  return mass * square(length) + machine_.arm_mass_kg * square(machine_.payload_length_m) / 3.0;
}

double ServoPlant::outer(double q, double t_s) const {
  const double length = machine_.payload_length_m + terms_.slide_by * gradual(t_s, terms_.slide_at);
  const double mass = machine_.payload_mass_kg - terms_.drop_by * gradual(t_s, terms_.drop_at);
  const double weight_Nm = machine_.gravity_m_s2 *
                           (mass * length + 0.5 * machine_.arm_mass_kg * machine_.payload_length_m);
  double torque = -weight_Nm * std::sin(q) - terms_.spring * (q - terms_.spring_rest);
  const double bent = q - terms_.hardening_rest;
  torque -= terms_.hardening * bent * bent * bent;
  if (q > terms_.stop_at) torque -= terms_.stop_stiffness * (q - terms_.stop_at);
  return torque;
}

/// Torque of the law before anything that the motor makes of it.
void ServoPlant::motor(const State& x, double t_s, Torques& out) const {
  if (t_s >= exercise_.disable_at_s) return;
  const double w = x[kSpeed];
  if (machine_.law == DriveLaw::kTorque) {
    out.commanded = exercise_.goal.value(t_s);
  } else if (machine_.law == DriveLaw::kImpedance) {
    out.commanded = held_;
  } else {
    const double volt = supply_at(t_s), duty = held_;
    const double kt = machine_.kt_Nm_A * (1.0 - terms_.derating * x[kHeat]);
    const double free_current = (duty * volt - kt * w) / machine_.resistance_ohm;
    // supply = volt - r |i duty| and i = (duty supply - kt w) / R, solved for i.
    const double loss = terms_.sag_resistance * duty * std::abs(duty);
    const double resistance = machine_.resistance_ohm + std::copysign(loss, loss * free_current);
    out.current_A = (duty * volt - kt * w) / std::max(resistance, 0.2 * machine_.resistance_ohm);
    out.unsagged = kt * free_current;
    out.commanded = kt * out.current_A;
    out.delivered = delivered(out.commanded, x[kAngle], w);
    if (out.delivered != out.commanded) out.current_A = out.delivered / kt;
    // For `strength`: what a cold motor would make of the same current.
    if (terms_.derating > 0.0) out.commanded = machine_.kt_Nm_A * out.current_A;
    return;
  }
  out.unsagged = out.commanded;
  out.current_A = out.commanded / machine_.kt_Nm_A;
  out.delivered = delivered(out.commanded, x[kAngle], w) * (1.0 - terms_.derating * x[kHeat]);
}

/// What becomes of a torque in motor and gear, but for heat and lag.
double ServoPlant::delivered(double torque, double angle, double speed) const {
  if (terms_.ripple > 0.0) torque *= 1.0 + terms_.ripple * std::sin(terms_.ripple_order * angle);
  if (torque > 0.0) torque *= 1.0 - terms_.uneven;
  if (torque * speed > 0.0 && terms_.fast_loss > 0.0) {
    torque *=
        1.0 - terms_.fast_loss * std::clamp(std::abs(speed) / terms_.fast_speed - 0.5, 0., 1.);
  }
  if (terms_.dead_zone > 0.0) {
    torque = std::copysign(std::max(std::abs(torque) - terms_.dead_zone, 0.0), torque);
  }
  return std::clamp(torque, -terms_.ceiling, terms_.ceiling);
}

/// Torque on the motor side by angle, speed and time that no law commands.
double ServoPlant::extra(const State& x, double t_s) const {
  const double q = x[kAngle], w = x[kSpeed];
  double torque = 0.0;
  if (terms_.cogging > 0.0) {
    torque += terms_.cogging * std::sin(terms_.cogging_order * q + terms_.cogging_phase);
  }
  torque -= terms_.drag * w * std::abs(w);
  if (terms_.hum > 0.0) {
    torque += terms_.hum * std::sin(2.0 * std::numbers::pi * terms_.hum_frequency * t_s);
  }
  if (terms_.detent > 0.0) {
    const double off = (q - terms_.detent_at) / terms_.detent_width;
    torque -= terms_.detent * off * std::exp(0.5 * (1.0 - off * off));
  }
  return torque;
}

/// Walls of the gap: as hard as makes motor and link bounce at 800 rad/s.
double ServoPlant::contact_stiffness() const {
  if (terms_.stiffness > 0.0) return terms_.stiffness;
  const double link = machine_.link_inertia_kgm2(), motor = machine_.armature_kgm2;
  return square(800.0) * link * motor / (link + motor);
}

double ServoPlant::dry_friction(const State& x, double t_s, const Torques& now, double sign) const {
  double coulomb = machine_.coulomb_Nm * (1.0 + terms_.asymmetry * sign);
  if (terms_.rough > 0.0) {
    coulomb *= 1.0 + terms_.rough * std::sin(terms_.rough_order * x[kAngle] + terms_.rough_phase);
  }
  if (terms_.wear_in != 0.0) {
    coulomb *= 1.0 + terms_.wear_in * std::max(t_s - exercise_.lead_in_s, 0.0) / terms_.wear_time;
  }
  if (terms_.stribeck_extra > 0.0) {
    coulomb += terms_.stribeck_extra * std::exp(-square(x[kSpeed] / terms_.stribeck_speed));
  }
  return coulomb + terms_.load_coefficient * std::abs(now.delivered - now.outer);
}

ServoPlant::Torques ServoPlant::torques(const State& x, double t_s) const {
  Torques out;
  motor(x, t_s, out);
  if (terms_.lag_time > 0.0) out.delivered = x[kLag];
  const bool two = terms_.two_masses();
  const double link_angle = two ? x[kLinkAngle] : x[kAngle];
  out.outer = outer(link_angle, t_s);
  out.link_inertia = payload_inertia(t_s);
  if (terms_.swing_share > 0.0) {
    const double part = terms_.swing_share * out.link_inertia;
    out.link_inertia -= part;
    const double rate = 2.0 * std::numbers::pi * terms_.swing_frequency;
    out.swing = part * (rate * rate * (x[kSwing] - x[kAngle]) +
                        2.0 * 0.03 * rate * (x[kSwingSpeed] - x[kSpeed]));
  }
  out.net = out.delivered + extra(x, t_s) - machine_.viscous_Nms_rad * x[kSpeed] + out.swing;
  if (!two) {
    out.inertia = out.link_inertia + machine_.armature_kgm2;
    out.net += out.outer;
    return out;
  }
  const double k = contact_stiffness();
  const double motor = machine_.armature_kgm2;
  const double apart = x[kAngle] - x[kLinkAngle];
  const double pressed = apart - std::clamp(apart, -0.5 * terms_.gap, 0.5 * terms_.gap);
  if (pressed != 0.0 || terms_.gap <= 0.0) {
    // A spring loses 2 % a radian of its swing, a wall nearly all.
    const double damping = terms_.stiffness > 0.0 ? 0.02 : 0.6;
    const double reduced = motor * out.link_inertia / (motor + out.link_inertia);
    out.coupling =
        k * pressed + 2.0 * damping * std::sqrt(k * reduced) * (x[kSpeed] - x[kLinkSpeed]);
    if (terms_.gap > 0.0 && out.coupling * pressed < 0.0) out.coupling = 0.0;  // walls do not pull
  }
  out.inertia = motor;
  out.net -= out.coupling;
  return out;
}

ServoPlant::State ServoPlant::rate(const State& x, double t_s) const {
  const Torques now = torques(x, t_s);
  State d{};
  double net = now.net;
  if (terms_.bristle_slip > 0.0) {
    // LuGre (Canudas de Wit et al. 1995) with a constant steady friction.
    const double stiffness = machine_.coulomb_Nm / terms_.bristle_slip;
    d[kBristle] = x[kSpeed] - std::abs(x[kSpeed]) * x[kBristle] / terms_.bristle_slip;
    net -= stiffness * x[kBristle] + 0.6 * std::sqrt(stiffness * now.inertia) * d[kBristle];
  } else if (direction_ != 0) {
    net -= direction_ * dry_friction(x, t_s, now, direction_);
  } else {
    net = 0.0;
  }
  d[kAngle] = direction_ == 0 ? 0.0 : x[kSpeed];
  d[kSpeed] = net / now.inertia;
  if (terms_.two_masses()) {
    d[kLinkAngle] = x[kLinkSpeed];
    d[kLinkSpeed] = (now.coupling + now.outer) / now.link_inertia;
  } else {
    d[kLinkAngle] = d[kAngle];
    d[kLinkSpeed] = d[kSpeed];
  }
  if (terms_.lag_time > 0.0) {
    Torques fresh;
    motor(x, t_s, fresh);
    d[kLag] = (fresh.delivered - x[kLag]) / terms_.lag_time;
  }
  if (terms_.derating > 0.0) {
    d[kHeat] = (square(now.current_A / terms_.heat_reference) - x[kHeat]) / terms_.heat_time;
  }
  if (terms_.swing_share > 0.0) {
    const double part = terms_.swing_share * payload_inertia(t_s);
    d[kSwing] = x[kSwingSpeed];
    d[kSwingSpeed] = -now.swing / part;
  }
  return d;
}

double ServoPlant::commanded_torque() const {
  Torques now;
  motor(state_, t_s_, now);
  return enabled() ? (machine_.law == DriveLaw::kDuty ? now.delivered : held_) : 0.0;
}

double ServoPlant::current() const {
  Torques now;
  motor(state_, t_s_, now);
  return now.current_A;
}

ServoMoment ServoPlant::moment() const {
  const Torques now = torques(state_, t_s_);
  const State d = rate(state_, t_s_);
  ServoMoment m;
  m.t_s = t_s_;
  m.position = state_[kAngle];
  m.velocity = state_[kSpeed];
  m.link_position = terms_.two_masses() ? state_[kLinkAngle] : state_[kAngle];
  m.link_velocity = d[kLinkAngle];
  m.acceleration = d[kSpeed];
  m.link_acceleration = d[kLinkSpeed];
  m.commanded_Nm = now.commanded;
  m.unsagged_Nm = now.unsagged;
  m.delivered_Nm = now.delivered;
  m.outer_Nm = now.outer;
  m.goal = exercise_.goal.value(t_s_);
  m.seen_goal = goal_;
  m.heat = state_[kHeat];
  m.swing_Nm = now.swing;
  return m;
}

}  // namespace hoof::tools::conceal
