#include "firmware/control/toe_opening.h"

#include "firmware/control/leg_dynamics.h"

namespace hoof::firmware::control {

ToeOpening::ToeOpening(const ToeSettings& settings, float period_s)
    : settings_(settings), period_s_(period_s), generator_(period_s) {
  input_.set_limits(0, settings.speed_rad_s, settings.acceleration_rad_s2, settings.jerk_rad_s3);
}

void ToeOpening::start(float measured_rad) {
  generator_.reset();
  input_.position = {measured_rad};
  target_rad_ = measured_rad;
  set_point_ = {};
  set_point_.position = {measured_rad};
  moving_ = false;
  jam_s_ = 0.0f;
}

JointCommand ToeOpening::step(const JointState& toe) {
  input_.target_position = {target_rad_};
  moving_ = generator_.update(input_, set_point_) == trajectory::Result::kWorking;
  watch_for_jam(toe);
  const float velocity_rad_s = set_point_.velocity[0];
  return {.position_rad = set_point_.position[0],
          .velocity_rad_s = velocity_rad_s,
          .kp_Nm_rad = settings_.kp_Nm_rad,
          .kd_Nm_s_rad = settings_.kd_Nm_s_rad,
          .torque_Nm = settings_.inertia_kg_m2 * set_point_.acceleration[0] +
                       smooth_friction_Nm(settings_.friction_Nm, velocity_rad_s)};
}

/// A jam may outlast the set point's own move, so what counts is the distance still to go; toes
/// that hold a load are off their target, too, but never so far.
void ToeOpening::watch_for_jam(const JointState& toe) {
  constexpr float kStandstill_rad_s = 0.06f;  // three codes of the reply's velocity
  const bool pushing = absolute(toe.torque_Nm) >= settings_.jam_torque_Nm;
  const bool still = absolute(toe.velocity_rad_s) < kStandstill_rad_s;
  const bool astray = absolute(target_rad_ - toe.position_rad) > settings_.jam_distance_rad;
  jam_s_ = pushing && still && astray ? jam_s_ + period_s_ : 0.0f;
}

}  // namespace hoof::firmware::control
