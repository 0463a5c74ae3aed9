// Opening of both toes by their one drive: jerk-limited moves, then holding by impedance.
#pragma once

#include "firmware/control/settings.h"
#include "firmware/control/types.h"
#include "firmware/trajectory/generator.h"

namespace hoof::firmware::control {

/// Holds without integral action, so that the deflection under load is load / kp: the foot gives
/// way like a hoof, and the deflection is a measure of the load.
class ToeOpening {
 public:
  ToeOpening(const ToeSettings& settings, float period_s);

  /// Begins at rest at the measured angle; the target is the same until move_to().
  void start(float measured_rad);

  /// New opening angle per toe, reached by a jerk-limited move from the present set point.
  void move_to(float angle_rad) { target_rad_ = angle_rad; }

  /// One tick: advances the set point and watches for a jam.
  JointCommand step(const JointState& toe);

  float target_rad() const { return target_rad_; }
  float set_point_rad() const { return set_point_.position[0]; }
  bool moving() const { return moving_; }
  /// The toe pushed hard without moving, far from its target, for long enough.
  bool jammed() const { return jam_s_ >= settings_.jam_time_s; }

 private:
  using Generator = trajectory::Generator<float, 1>;

  void watch_for_jam(const JointState& toe);

  ToeSettings settings_;
  float period_s_;
  Generator generator_;
  Generator::InputType input_;
  Generator::OutputType set_point_;
  float target_rad_ = 0.0f;
  bool moving_ = false;
  float jam_s_ = 0.0f;
};

}  // namespace hoof::firmware::control
