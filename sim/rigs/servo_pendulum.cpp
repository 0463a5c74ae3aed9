// Symbols, all at the output:
//   q, w   angle and speed of the motor's side      tau  torque of the motor, held for one step
//   a, v   angle and speed of the link              F    Coulomb friction      b  viscous friction
//   J      inertia in motion                        h    step
#include "sim/rigs/servo_pendulum.h"

#include <algorithm>
#include <cmath>

namespace hoof::sim {
namespace {

/// A gear that only has play is stiff; its teeth swing with this angular frequency, well damped.
/// Far above what a position loop reaches, low enough for the step.
constexpr double kToothSwing_rad_s = 900;
constexpr double kToothDamping = 0.7;
/// Of a compliant joint: share of critical damping, as of steel and plastic gears.
constexpr double kSpringDamping = 0.02;
constexpr double kGearStep_s = 0.5e-3;

/// Of a switch within a span of time: on or off at its start and end, and the share before it
/// turns.
struct Switching {
  bool first = true, last = true;
  double until = 1;
};

/// A recorded input between its samples: linear, a cubic where its bend is known, or the nearest
/// where it is a switch. Cursors only go forward but for goals that are read late.
class Signal {
 public:
  Signal(std::span<const double> time_s, std::span<const double> values,
         std::span<const SlopeOffset> bends = {})
      : time_s_(time_s), values_(values), bends_(bends) {}

  bool present() const { return !values_.empty(); }

  double at(double t_s) {
    seek(t_s);
    const std::size_t i = cursor_;
    if (i + 1 >= values_.size() || t_s <= time_s_[i]) return values_[i];
    const double span = time_s_[i + 1] - time_s_[i];
    const double x = (t_s - time_s_[i]) / span;
    const double straight = values_[i] + x * (values_[i + 1] - values_[i]);
    if (bends_.empty()) return straight;
    return straight + span * x * (1 - x) * ((1 - x) * bends_[i].start - x * bends_[i].end);
  }
  std::size_t nearest(double t_s) {
    seek(t_s);
    const std::size_t i = cursor_;
    return i + 1 < time_s_.size() && time_s_[i + 1] - t_s < t_s - time_s_[i] ? i + 1 : i;
  }
  /// A switch turned somewhere between two samples, in the middle for all that is known.
  Switching switching(double from_s, double to_s) {
    Switching s;
    s.first = values_[nearest(from_s)] > 0.5;
    const std::size_t i = nearest(to_s);
    s.last = values_[i] > 0.5;
    if (s.first == s.last || i == 0) return s;
    const double turned_s = 0.5 * (time_s_[i - 1] + time_s_[i]);
    s.until = std::clamp((turned_s - from_s) / (to_s - from_s), 0.0, 1.0);
    return s;
  }

 private:
  void seek(double t_s) {
    while (cursor_ > 0 && time_s_[cursor_] > t_s + 1e-9) --cursor_;
    while (cursor_ + 1 < time_s_.size() && time_s_[cursor_ + 1] <= t_s + 1e-9) ++cursor_;
  }

  std::span<const double> time_s_, values_;
  std::span<const SlopeOffset> bends_;
  std::size_t cursor_ = 0;
};

struct Stages {
  std::vector<JointEffect*> goal, supply, motor, friction, link, sensor;
  double gap_rad = 0;
  double stiffness_Nm_rad = 0;

  explicit Stages(std::span<JointEffect* const> effects) {
    for (JointEffect* effect : effects) {
      const unsigned stages = effect->stages();
      if (stages & kGoalStage) goal.push_back(effect);
      if (stages & kSupplyStage) supply.push_back(effect);
      if (stages & kMotorStage) motor.push_back(effect);
      if (stages & kFrictionStage) friction.push_back(effect);
      if (stages & kLinkStage) link.push_back(effect);
      if (stages & kSensorStage) sensor.push_back(effect);
      if (stages & kGearStage) {
        gap_rad += effect->gap_rad();
        if (effect->stiffness_Nm_rad() > 0) stiffness_Nm_rad = effect->stiffness_Nm_rad();
      }
    }
  }
  bool geared() const { return gap_rad > 0 || stiffness_Nm_rad > 0; }
};

class Pendulum {
 public:
  Pendulum(const PendulumSettings& settings, const PendulumInputs& in,
           std::span<JointEffect* const> effects, const PendulumStart& start,
           const PendulumCorrection& correction, double longest_step_s, PendulumTrace& out)
      : s_(settings),
        in_(in),
        stages_(effects),
        correction_(correction),
        out_(out),
        goal_(in.time_s, in.position_goal_rad, in.position_goal_bend_rad_s),
        velocity_goal_(in.time_s, in.velocity_goal_rad_s, in.velocity_goal_bend_rad_s2),
        feed_forward_(in.time_s, in.torque_ff_Nm, in.torque_ff_bend_Nm_s),
        enable_(in.time_s, in.enable),
        supply_(in.time_s, in.supply_V),
        torque_(in.time_s, in.torque_Nm) {
    for (JointEffect* effect : effects) {
      effect->reset(start.current_rms_A, start.torque_rms_Nm);
      delay_s_ += effect->goal_delay_s();
    }
    delay_s_ += s_.input_late_s;
    effects_act_ = !stages_.motor.empty() || !stages_.friction.empty() || !stages_.link.empty();
    gravity_Nm_ = s_.gravity_torque_Nm();
    link_inertia_ = s_.link_inertia_kg_m2();
    inertia_ = std::max(link_inertia_ + s_.armature_kg_m2, 1e-9);
    place(start);
    choose_step(longest_step_s);
    prepare_gear();
  }

  void run();

 private:
  void place(const PendulumStart& start);
  void choose_step(double longest_step_s);
  void prepare_gear();
  double reading_rad(double q) const;
  double slope(double q) const;
  void read_goals(double t_s);
  void evaluate_law(double t_s);
  double drive_torque_Nm();
  double friction_Nm(double w, double coulomb_direction) const;
  void advance(double t_s);
  void step();
  void step_geared();
  double link_torque_Nm(double q, double w) const;
  double slide(double w0, double push_Nm, double inertia, double h);
  double effect_torque_Nm() const;
  void sample(std::size_t i, double share);
  void correct(std::size_t i);

  const PendulumSettings& s_;
  const PendulumInputs& in_;
  Stages stages_;
  PendulumCorrection correction_;
  PendulumTrace& out_;
  Signal goal_, velocity_goal_, feed_forward_, enable_, supply_, torque_;

  double delay_s_ = 0;
  double gravity_Nm_ = 0, link_inertia_ = 0, inertia_ = 0;
  double h_ = 0;
  int steps_per_law_ = 1;
  bool geared_ = false;
  bool effects_act_ = false;  // on torques
  double gear_stiffness_ = 0, gear_damping_ = 0;

  double q_ = 0, w_ = 0, a_ = 0, v_ = 0;  // now
  double q0_ = 0, w0_ = 0;                // at the start of the step
  double external_Nm_ = 0;                // of gravity and springs on the link
  double position_goal_ = 0, velocity_goal_now_ = 0, feed_forward_now_ = 0;
  bool enabled_ = true;
  double law_Nm_ = 0;  // what the law asks for; the drive gives it where it is on
  double duty_ = 0, volt_ = 0, command_Nm_ = 0, motor_Nm_ = 0, current_A_ = 0;
  double way_ = 0;    // of the last slide
  double now_s_ = 0;  // since the first sample
};

double Pendulum::reading_rad(double q) const {
  for (const JointEffect* effect : stages_.sensor) q = effect->reading_rad(q);
  return q;
}

double Pendulum::slope(double q) const {
  double slope = 1;
  for (const JointEffect* effect : stages_.sensor) slope *= effect->reading_slope(q);
  return slope;
}

void Pendulum::place(const PendulumStart& start) {
  q_ = start.position_rad;
  // The angle at which the encoder reads that, by Newton; its slope is near one.
  for (int i = 0; i < 8 && !stages_.sensor.empty(); ++i) {
    q_ -= (reading_rad(q_) - start.position_rad) / slope(q_);
  }
  w_ = start.velocity_rad_s / slope(q_);
  a_ = q_;
  v_ = w_;
}

void Pendulum::choose_step(double longest_step_s) {
  geared_ = stages_.geared();
  if (geared_) longest_step_s = std::min(longest_step_s, kGearStep_s);
  if (s_.control_period_s <= 0) {
    h_ = longest_step_s;
    return;
  }
  steps_per_law_ = static_cast<int>(std::ceil(s_.control_period_s / longest_step_s - 1e-9));
  h_ = s_.control_period_s / steps_per_law_;
}

void Pendulum::prepare_gear() {
  if (!geared_) return;
  const double motor = std::max(s_.armature_kg_m2, 0.02 * inertia_);
  const double both = motor * link_inertia_ / (motor + link_inertia_);
  const double tooth = both * kToothSwing_rad_s * kToothSwing_rad_s;
  const bool soft = stages_.stiffness_Nm_rad > 0;
  gear_stiffness_ = soft ? std::min(stages_.stiffness_Nm_rad, tooth) : tooth;
  const double share = soft ? kSpringDamping : kToothDamping;
  gear_damping_ = 2 * share * std::sqrt(gear_stiffness_ * both);
  // At the start the link hangs on the teeth by its weight.
  const double load = -gravity_Nm_ * std::sin(q_);
  const double side = load > 0 ? 1 : -1;
  a_ = q_ + 0.5 * side * stages_.gap_rad + load / gear_stiffness_;
}

void Pendulum::read_goals(double t_s) {
  const auto heard = [t_s](const LostGoals& span) { return span.until_s <= t_s + 1e-9; };
  const auto span = std::partition_point(in_.lost.begin(), in_.lost.end(), heard);
  bool lost = span != in_.lost.end() && span->from_s <= t_s + 1e-9;
  for (JointEffect* effect : stages_.goal) lost = effect->goal_lost() || lost;
  if (lost) return;
  const double t = std::max(t_s - delay_s_, in_.time_s.front());
  if (goal_.present()) position_goal_ = goal_.at(t);
  if (velocity_goal_.present()) velocity_goal_now_ = velocity_goal_.at(t);
  if (feed_forward_.present()) feed_forward_now_ = feed_forward_.at(t);
}

void Pendulum::evaluate_law(double t_s) {
  if (s_.law == PendulumLaw::kTorque) {
    law_Nm_ = torque_.at(std::max(t_s - s_.input_late_s, in_.time_s.front()));
    return;
  }
  read_goals(t_s);
  const double error = position_goal_ - reading_rad(q_);
  if (s_.law == PendulumLaw::kDuty) {
    duty_ = std::clamp(s_.kp_duty * s_.counts_per_rad * error / kDutyCounts, -1.0, 1.0);
    volt_ = supply_.present() ? supply_.at(t_s) : s_.supply_V;
    return;
  }
  const double torque = s_.kp_Nm_rad * error +
                        s_.kd_Nm_s_rad * (velocity_goal_now_ - slope(q_) * w_) + feed_forward_now_;
  law_Nm_ = std::clamp(torque, -s_.torque_limit_Nm, s_.torque_limit_Nm);
}

double Pendulum::drive_torque_Nm() {
  if (s_.law == PendulumLaw::kDuty) {
    double volt = volt_;
    // What was measured has sagged already.
    for (const JointEffect* effect : stages_.supply) {
      if (!supply_.present()) volt = effect->supply_V(volt, current_A_, duty_);
    }
    const double share = s_.kt_Nm_A / s_.resistance_ohm;
    command_Nm_ = enabled_ ? share * (duty_ * volt - s_.kt_Nm_A * w_) : 0;
    current_A_ = command_Nm_ / s_.kt_Nm_A;
  } else {
    command_Nm_ = enabled_ || s_.law == PendulumLaw::kTorque ? law_Nm_ : 0;
  }
  double torque = command_Nm_;
  if (enabled_) {
    for (JointEffect* effect : stages_.motor) torque = effect->motor_torque_Nm(torque, w_, h_);
  }
  return torque;
}

/// Coulomb friction that resists motion at w; at rest, motion that would begin with the sign of
/// `direction`.
double Pendulum::friction_Nm(double w, double direction) const {
  double friction = s_.coulomb_Nm;
  if (stages_.friction.empty()) return friction;
  const double seen = w != 0 ? w : std::copysign(1e-12, direction);
  const JointMotion motion{seen, motor_Nm_, external_Nm_, s_.coulomb_Nm, q0_, now_s_};
  for (const JointEffect* effect : stages_.friction) friction += effect->friction_Nm(motion);
  return std::max(friction, 0.0);
}

/// What effects do to the torques of this step, for those who ask where they act.
double Pendulum::effect_torque_Nm() const {
  double sum = std::abs(motor_Nm_ - (enabled_ ? command_Nm_ : 0));
  if (!stages_.friction.empty()) sum += std::abs(friction_Nm(w0_, w0_) - s_.coulomb_Nm);
  if (!stages_.link.empty()) sum += std::abs(external_Nm_ + gravity_Nm_ * std::sin(q0_));
  return sum;
}

double Pendulum::link_torque_Nm(double q, double w) const {
  double torque = -gravity_Nm_ * std::sin(q);
  for (JointEffect* effect : stages_.link) {
    torque += effect->link_torque_Nm(q, w, now_s_);
  }
  return torque;
}

/// Speed after h of a mass pushed by a constant torque against friction; its way in way_. Exact in
/// the moment at which it stops, second order in viscous friction.
double Pendulum::slide(double w0, double push, double inertia, double h) {
  const double half = 0.5 * h * s_.viscous_Nm_s_rad / inertia;
  const double direction = w0 != 0 ? w0 : push;
  const double friction = friction_Nm(w0, push);
  if (w0 == 0 && std::abs(push) <= friction) {
    way_ = 0;
    return 0;
  }
  const double net = push - std::copysign(friction, direction);
  const double w1 = ((1 - half) * w0 + h * net / inertia) / (1 + half);
  if (w0 == 0 || w1 * w0 > 0) {
    way_ = 0.5 * h * (w0 + w1);
    return w1;
  }
  // It stops on the way, and may be pushed back from there.
  const double until = h * w0 / (w0 - w1);
  const double way = 0.5 * until * w0;
  const double rest = h - until;
  const double holding = friction_Nm(0, push);
  if (std::abs(push) <= holding) {
    way_ = way;
    return 0;
  }
  const double back = (push - std::copysign(holding, push)) * rest / inertia;
  way_ = way + 0.5 * rest * back;
  return back;
}

/// One step, in two parts where the drive turns on or off within it: half a step at full torque is
/// not a step at half of it where a joint sticks.
void Pendulum::advance(double t_s) {
  const auto part = [this](double length) {
    const double whole = h_;
    h_ = length;
    geared_ ? step_geared() : step();
    h_ = whole;
  };
  if (!enable_.present()) return part(h_);
  const double from = t_s - s_.switch_late_s;
  const Switching turn = enable_.switching(from, from + h_);
  enabled_ = turn.first;
  if (turn.until > 0) part(turn.until * h_);
  enabled_ = turn.last;
  if (turn.until < 1) part((1 - turn.until) * h_);
}

void Pendulum::step() {
  motor_Nm_ = drive_torque_Nm();
  const double middle = q_ + 0.5 * h_ * w_;
  external_Nm_ = link_torque_Nm(middle, w_);
  w_ = slide(w_, motor_Nm_ + external_Nm_, inertia_, h_);
  q_ += way_;
}

void Pendulum::step_geared() {
  motor_Nm_ = drive_torque_Nm();
  const double motor = std::max(s_.armature_kg_m2, 0.02 * inertia_);
  const double external = link_torque_Nm(a_ + 0.5 * h_ * v_, v_);
  external_Nm_ = external;
  // Implicit in the gear: the torque at the end of the step, by the speeds there.
  const double twist = q_ - a_;
  const double half_gap = 0.5 * stages_.gap_rad;
  const double next = twist + h_ * (w_ - v_);
  const double seat = std::abs(next) > half_gap ? std::copysign(half_gap, next) : next;
  const bool touching = half_gap == 0 || std::abs(next) > half_gap;
  const double k = touching ? gear_stiffness_ : 0;
  const double c = touching ? gear_damping_ : 0;
  const double stiff = h_ * (c + h_ * k);  // torque at the end = k (twist - seat) + stiff/h (w - v)
  const double spring = touching ? k * (twist - seat) : 0;
  // Link eliminated: v = (J_l v0 + h (external + spring) + stiff w) / (J_l + stiff).
  const double link = link_inertia_;
  const double v_known = (link * v_ + h_ * (external + spring)) / (link + stiff);
  const double share = stiff / (link + stiff);
  // Motor: (J_m + stiff (1 - share)) w1 = J_m w0 + h (tau - spring - friction) + stiff v_known.
  const double added = stiff * (1 - share);
  const double push = motor_Nm_ - spring + (stiff * v_known - added * w_) / h_;
  const double w1 = slide(w_, push, motor + added, h_);
  const double v1 = v_known + share * w1;
  q_ += way_;
  a_ += 0.5 * h_ * (v_ + v1);
  w_ = w1;
  v_ = v1;
}

/// Writes sample i, which lies `share` of a step after the state at its start.
void Pendulum::sample(std::size_t i, double share) {
  // Cubic through both ends with their speeds.
  const double d = q_ - q0_, x = share;
  const double q =
      q0_ + x * (h_ * w0_ + x * (3 * d - h_ * (2 * w0_ + w_) + x * (h_ * (w0_ + w_) - 2 * d)));
  const double w = w0_ + x * (w_ - w0_);
  out_.position_rad[i] = reading_rad(q);
  out_.velocity_rad_s[i] = slope(q) * w;
  out_.torque_Nm[i] = command_Nm_;
  out_.effect_Nm[i] = effects_act_ ? effect_torque_Nm() : 0;
  out_.current_A[i] = s_.kt_Nm_A > 0 ? command_Nm_ / s_.kt_Nm_A : 0;
}

void Pendulum::correct(std::size_t i) {
  if (correction_.angle == 0 && correction_.speed_1_s == 0) return;
  const double error = in_.position_rad[i] - out_.position_rad[i];
  if (!std::isfinite(error)) return;
  q_ += correction_.angle * error;
  a_ += correction_.angle * error;
  w_ += correction_.speed_1_s * error;
  v_ += correction_.speed_1_s * error;
}

void Pendulum::run() {
  const std::size_t n = in_.time_s.size();
  for (std::vector<double>* channel : {&out_.position_rad, &out_.velocity_rad_s, &out_.torque_Nm,
                                       &out_.current_A, &out_.effect_Nm}) {
    channel->resize(n);
  }
  const double start = in_.time_s.front();
  std::size_t next = 0;
  for (long k = 0; next < n; ++k) {
    const double t = start + static_cast<double>(k) * h_;
    if (k % steps_per_law_ == 0) evaluate_law(t);
    now_s_ = t - start;
    q0_ = q_;
    w0_ = w_;
    advance(t);
    const std::size_t first = next;
    while (next < n && in_.time_s[next] < t + h_ * (1 - 1e-9)) {
      sample(next, std::max(0.0, (in_.time_s[next] - t) / h_));
      ++next;
    }
    for (std::size_t i = first; i < next; ++i) correct(i);
  }
}

}  // namespace

double PendulumSettings::link_inertia_kg_m2() const {
  return (payload_mass_kg + arm_mass_kg / 3) * payload_length_m * payload_length_m;
}

double PendulumSettings::gravity_torque_Nm() const {
  return gravity_m_s2 * payload_length_m * (payload_mass_kg + arm_mass_kg / 2);
}

void simulate_pendulum(const PendulumSettings& settings, const PendulumInputs& inputs,
                       std::span<JointEffect* const> effects, const PendulumStart& start,
                       const PendulumCorrection& correction, double longest_step_s,
                       PendulumTrace& trace) {
  Pendulum(settings, inputs, effects, start, correction, longest_step_s, trace).run();
}

}  // namespace hoof::sim
