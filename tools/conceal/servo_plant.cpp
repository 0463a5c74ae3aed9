#include "tools/conceal/servo_plant.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools::conceal {
namespace {

constexpr double kSettling_s = 1.0;
/// Times closer than this are the same.
constexpr double kInstant_s = 1e-9;

}  // namespace

ServoPlant::ServoPlant(const ServoMachine& machine, const std::vector<HiddenEffect>& hidden,
                       const ServoExercise& exercise, double step_s)
    : machine_(machine),
      terms_(terms_of(hidden)),
      exercise_(exercise),
      step_s_(step_s),
      losses_(exercise.loss_seed) {}

void ServoPlant::start_at_rest() {
  t_s_ = -kSettling_s;
  next_tick_ = std::lround(t_s_ / machine_.control_period_s);
  state_ = {};
  if (machine_.law != DriveLaw::kTorque) state_[kAngle] = exercise_.goal.value(0.0);
  start_with(state_[kAngle], 0.0);
}

void ServoPlant::start_with(double position_rad, double velocity_rad_s) {
  state_[kAngle] = state_[kLinkAngle] = state_[kSwing] = position_rad;
  state_[kSpeed] = state_[kLinkSpeed] = state_[kSwingSpeed] = velocity_rad_s;
  if (t_s_ >= 0.0 || next_tick_ == 0) {
    t_s_ = exercise_.lead_in_s;
    next_tick_ = std::lround(t_s_ / machine_.control_period_s);
  }
  // The link hangs on the side of the gap that gravity pulls it to, the spring is stretched.
  const double pull = outer(position_rad, t_s_);
  if (terms_.gap > 0.0 && pull != 0.0) state_[kLinkAngle] += 0.5 * std::copysign(terms_.gap, pull);
  if (terms_.stiffness > 0.0) state_[kLinkAngle] += pull / terms_.stiffness;
  tick();
  Torques now;
  motor(state_, t_s_, now);
  state_[kLag] = now.delivered;
  direction_ = velocity_rad_s > 0.0 ? 1 : velocity_rad_s < 0.0 ? -1 : 0;
}

bool ServoPlant::sane() const {
  return std::isfinite(state_[kAngle]) && std::abs(state_[kAngle]) < 2.8 &&
         std::abs(state_[kSpeed]) < 60.0 && terms_.derating * state_[kHeat] < 0.7;
}

void ServoPlant::advance_to(double t_s) {
  while (t_s_ < t_s - kInstant_s) {
    const double tick_s = double(next_tick_) * machine_.control_period_s;
    const double until_s = std::min(t_s, tick_s);
    const double span_s = until_s - t_s_;
    if (span_s > kInstant_s) {
      const int count = int(std::ceil(span_s / step_s_ - 1e-6));
      for (int i = 0; i < count; ++i) substep(span_s / count);
    }
    t_s_ = until_s;
    if (tick_s <= t_s + kInstant_s) tick();
    if (!sane()) return;
  }
}

double ServoPlant::encoder(double position) const {
  double bent = position;
  if (terms_.eccentricity > 0.0) {
    bent += terms_.eccentricity * std::sin(position + terms_.eccentricity_phase);
  }
  const double step = exercise_.encoder_step_rad;
  return step > 0.0 ? step * std::round(bent / step) : bent;
}

double ServoPlant::measured_position() const {
  if (terms_.late_sensor <= 0.0 || past_times_.empty()) return encoder(state_[kAngle]);
  const double then = t_s_ - terms_.late_sensor;
  const auto after = std::upper_bound(past_times_.begin(), past_times_.end(), then);
  if (after == past_times_.begin()) return encoder(past_positions_.front());
  if (after == past_times_.end()) return encoder(past_positions_.back());
  const std::size_t i = std::size_t(after - past_times_.begin());
  const double share = (then - past_times_[i - 1]) / (past_times_[i] - past_times_[i - 1]);
  return encoder(past_positions_[i - 1] + share * (past_positions_[i] - past_positions_[i - 1]));
}

double ServoPlant::measured_velocity() const {
  return state_[kSpeed] *
         (1.0 + terms_.eccentricity * std::cos(state_[kAngle] + terms_.eccentricity_phase));
}

double ServoPlant::supply_at(double t_s) const {
  if (exercise_.supply_wander.sines.empty()) return machine_.supply_V;
  return machine_.supply_V + exercise_.supply_wander.value(t_s);
}

double ServoPlant::supply() const {
  return supply_at(t_s_);
}

/// What the drive does each control period: takes the goal, reads the encoder, sets its output.
void ServoPlant::tick() {
  next_tick_ = std::lround(t_s_ / machine_.control_period_s) + 1;
  if (terms_.late_sensor > 0.0) {
    past_times_.push_back(t_s_);
    past_positions_.push_back(state_[kAngle]);
  }
  const bool recorded = t_s_ >= exercise_.lead_in_s;
  if (terms_.loss_probability > 0.0 && recorded) {
    if (lost_left_ > 0) {
      --lost_left_;
    } else if (losses_.chance(terms_.loss_probability)) {
      lost_left_ = int(std::lround(terms_.loss_burst));
    }
  }
  if (lost_left_ == 0) {
    goal_ = exercise_.goal.value(t_s_ - terms_.delay);
    goal_rate_ = exercise_.velocity_goal ? exercise_.goal.rate(t_s_ - terms_.delay) : 0.0;
  }
  const double error = goal_ - measured_position();
  if (machine_.law == DriveLaw::kImpedance) {
    double feed = 0.0;
    if (exercise_.feed_gravity_Nm > 0.0) {
      feed = feed_forward(exercise_, t_s_ - terms_.delay);
    }
    const double wish =
        exercise_.gain * error + machine_.kd_Nms_rad * (goal_rate_ - measured_velocity()) + feed;
    held_ = std::clamp(wish, -machine_.torque_limit_Nm, machine_.torque_limit_Nm);
  } else if (machine_.law == DriveLaw::kDuty) {
    held_ = std::clamp(exercise_.gain * machine_.counts_per_rad * error / 256.0 / 885.0, -1.0, 1.0);
  }
}

void ServoPlant::substep(double step_s) {
  if (terms_.bristle_slip > 0.0) direction_ = 1;  // bristles know no rest
  double left_s = step_s;
  for (int part = 0; part < 4 && left_s > 0.0; ++part) {
    if (direction_ == 0) settle_direction();
    const State next = runge_kutta(state_, t_s_, left_s);
    const bool reversed =
        terms_.bristle_slip <= 0.0 && direction_ != 0 && next[kSpeed] * direction_ < 0.0;
    if (!reversed) {
      state_ = next;
      t_s_ += left_s;
      return;
    }
    // The speed is close to linear within a step: go to where it is zero, and think again.
    const double share = std::clamp(state_[kSpeed] / (state_[kSpeed] - next[kSpeed]), 0.0, 1.0);
    if (share > 0.0) state_ = runge_kutta(state_, t_s_, share * left_s);
    t_s_ += share * left_s;
    left_s *= 1.0 - share;
    state_[kSpeed] = 0.0;
    if (!terms_.two_masses()) state_[kLinkSpeed] = 0.0;
    direction_ = 0;
  }
  t_s_ += left_s;
}

/// At rest: stays so, or slides to the side of what pulls.
void ServoPlant::settle_direction() {
  const Torques now = torques(state_, t_s_);
  const double side = now.net < 0.0 ? -1.0 : 1.0;
  if (std::abs(now.net) > dry_friction(state_, t_s_, now, side)) direction_ = int(side);
}

ServoPlant::State ServoPlant::runge_kutta(const State& x, double t_s, double h) const {
  const auto moved = [&x](const State& k, double by) {
    State y;
    for (int i = 0; i < kSlots; ++i) y[i] = x[i] + by * k[i];
    return y;
  };
  const State k1 = rate(x, t_s);
  const State k2 = rate(moved(k1, 0.5 * h), t_s + 0.5 * h);
  const State k3 = rate(moved(k2, 0.5 * h), t_s + 0.5 * h);
  const State k4 = rate(moved(k3, h), t_s + h);
  State y;
  for (int i = 0; i < kSlots; ++i) {
    y[i] = x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  return y;
}

double feed_forward(const ServoExercise& exercise, double t_s) {
  constexpr double kStep_s = 1e-3;
  const double acceleration =
      (exercise.goal.rate(t_s + kStep_s) - exercise.goal.rate(t_s - kStep_s)) / (2.0 * kStep_s);
  return exercise.feed_gravity_Nm * std::sin(exercise.goal.value(t_s)) +
         exercise.feed_inertia_kgm2 * acceleration;
}

ServoSignals run_servo(const ServoMachine& machine, const std::vector<HiddenEffect>& hidden,
                       const ServoExercise& exercise, const ServoStart& start, double step_s) {
  const ServoTerms terms = terms_of(hidden);
  ServoPlant plant(machine, hidden, exercise, step_s);
  if (start.given) {
    plant.start_with(start.position_rad, start.velocity_rad_s);
  } else {
    plant.start_at_rest();
  }
  ServoSignals out;
  out.influence.resize(hidden.size());
  const double count = double(exercise.times_s.size());
  for (const double sample_s : exercise.times_s) {
    const double t_s = sample_s + exercise.lead_in_s;
    if (out.sane) plant.advance_to(t_s);
    out.sane = out.sane && plant.sane();
    const bool torque_law = machine.law == DriveLaw::kTorque;
    out.position_goal.push_back(exercise.goal.value(t_s));
    out.velocity_goal.push_back(exercise.goal.rate(t_s));
    out.torque_ff.push_back(feed_forward(exercise, t_s));
    out.enable.push_back(t_s < exercise.disable_at_s ? 1.0 : 0.0);
    out.supply_voltage.push_back(plant.supply());
    out.position.push_back(plant.measured_position());
    out.velocity.push_back(plant.measured_velocity());
    out.torque.push_back(torque_law ? exercise.goal.value(t_s) : plant.commanded_torque());
    const double current = plant.current();
    out.current.push_back(current);
    out.square_current_mean += current * current / count;
    out.fourth_current_mean += current * current * current * current / count;
    out.square_heat_mean += plant.heat_A2() * plant.heat_A2() / count;
    const ServoMoment moment = plant.moment();
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      out.influence[i].push_back(strength(hidden[i].name, terms, machine, moment));
    }
  }
  return out;
}

}  // namespace hoof::tools::conceal
