#pragma once

#include <array>
#include <vector>

#include "tools/conceal/random_stream.h"
#include "tools/conceal/servo_machine.h"
#include "tools/conceal/servo_terms.h"

namespace hoof::tools::conceal {

/// The machine in motion, one exercise long. The motor side carries friction, armature, encoder;
/// the link follows through a gap or a spring where there is one, else rigidly.
class ServoPlant {
 public:
  ServoPlant(const ServoMachine& machine, const std::vector<HiddenEffect>& hidden,
             const ServoExercise& exercise, double step_s);

  void start_at_rest();  ///< where the path begins, one second before it
  void start_with(double position_rad, double velocity_rad_s);

  /// On to a time of the path; the law is evaluated at each whole control period on the way.
  void advance_to(double t_s);

  double time_s() const { return t_s_; }
  bool sane() const;
  /// As recorded without noise, at this time.
  double measured_position() const;
  double measured_velocity() const;
  double commanded_torque() const;
  double current() const;
  double supply() const;
  double enable() const { return enabled() ? 1.0 : 0.0; }
  double heat_A2() const { return state_[kHeat] * terms_.heat_reference * terms_.heat_reference; }
  double position() const { return state_[kAngle]; }
  double velocity() const { return state_[kSpeed]; }
  double link_position() const { return state_[kLinkAngle]; }
  bool stuck() const { return direction_ == 0; }
  ServoMoment moment() const;

 private:
  enum Slot {
    kAngle,
    kSpeed,
    kLinkAngle,
    kLinkSpeed,
    kLag,
    kHeat,
    kBristle,
    kSwing,
    kSwingSpeed,
    kSlots
  };
  using State = std::array<double, kSlots>;

  /// Torques at one moment, Nm.
  struct Torques {
    double commanded = 0, unsagged = 0, delivered = 0, current_A = 0;
    double outer = 0;     ///< gravity and springs on the link
    double coupling = 0;  ///< link pulled by motor
    double swing = 0;
    double net = 0;  ///< on the motor side (all of it with one mass) before dry friction
    double inertia = 1, link_inertia = 1;
  };

  bool enabled() const { return t_s_ < exercise_.disable_at_s; }
  void tick();
  void substep(double step_s);
  State runge_kutta(const State& x, double t_s, double step_s) const;
  State rate(const State& x, double t_s) const;
  Torques torques(const State& x, double t_s) const;
  void motor(const State& x, double t_s, Torques& out) const;
  double delivered(double torque, double angle, double speed) const;
  double outer(double link_angle, double t_s) const;
  double contact_stiffness() const;
  double extra(const State& x, double t_s) const;
  /// Largest dry friction (Nm) against motion to the side of `sign`.
  double dry_friction(const State& x, double t_s, const Torques& torques, double sign) const;
  double payload_inertia(double t_s) const;
  void settle_direction();
  double encoder(double position) const;
  double supply_at(double t_s) const;

  ServoMachine machine_;
  ServoTerms terms_;
  ServoExercise exercise_;
  double step_s_;
  double t_s_ = 0;
  long next_tick_ = 0;
  State state_{};
  int direction_ = 0;  ///< of sliding; 0 = held by friction
  double held_ = 0;    ///< the law's last output: Nm, or duty
  double goal_ = 0, goal_rate_ = 0;
  RandomStream losses_{0};
  int lost_left_ = 0;
  std::vector<double> past_times_, past_positions_;  ///< only with a late sensor
};

}  // namespace hoof::tools::conceal
