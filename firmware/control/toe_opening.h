// Opening of both toes by their one drive: jerk-limited moves, then holding by impedance.
#pragma once

#include "firmware/control/settings.h"
#include "firmware/control/types.h"
#include "firmware/trajectory/generator.h"

namespace hoof::firmware::control {

/// Holds without integral action, so that the deflection under load is load / kp: the foot gives
/// way like a hoof, and the deflection is a measure of the load.
///
/// A move that cannot be carried out is a jam or a stall. Both are watched from the order until the
/// toe has been near its target once: after that a toe far away is loaded, not blocked, however far
/// the torque gate lets it give way.
class ToeOpening {
 public:
  ToeOpening(const ToeSettings& settings, float period_s);

  /// Begins at rest at the measured angle; the target is the same until move_to().
  void start(float measured_rad);

  /// New opening angle per toe, reached by a jerk-limited move from the present set point.
  void move_to(float angle_rad);

  /// Ends the move under way as soon as the limits allow; where that leads is the target then.
  void halt() { halting_ = moving_; }

  /// One tick: advances the set point and watches the move.
  JointCommand step(const JointState& toe);

  float target_rad() const { return target_rad_; }
  float set_point_rad() const { return set_point_.position[0]; }
  /// The set point is not at its target yet, or its move is still being planned.
  bool moving() const { return moving_; }
  /// In a move, the toe pushed hard without moving, far behind its set point, for long enough.
  bool jammed() const { return jam_s_ >= settings_.jam_time_s; }
  /// The same without the push; or a move that the settings do not allow at all.
  bool stalled() const {
    return planless_ || (stuck_s_ >= settings_.stall_time_s && jam_s_ == 0.0f);
  }

  /// No move of this length, from rest to rest, takes longer, its planning included.
  float longest_move_s(float way_rad) const;

 private:
  using Generator = trajectory::Generator<float, 1>;

  void advance_set_point();
  void watch_move(const JointState& toe);

  ToeSettings settings_;
  float period_s_;
  Generator generator_;
  Generator::InputType input_;
  Generator::OutputType set_point_;
  float target_rad_ = 0.0f;
  bool moving_ = false;
  bool halting_ = false;
  bool planless_ = false;
  bool arrived_ = true;       // the toe itself, near its target
  float arrived_rad_ = 0.0f;  // that target
  float jam_s_ = 0.0f;
  float stuck_s_ = 0.0f;
};

}  // namespace hoof::firmware::control
