#include "firmware/control/homing.h"

#include "firmware/control/math.h"

namespace hoof::firmware::control {

void Homing::start() {
  elapsed_s_ = 0.0f;
  stalled_s_ = 0.0f;
}

HomingResult Homing::step(const JointState& toe, JointCommand& command) {
  elapsed_s_ += period_s_;
  const bool pushing = toe.torque_Nm <= -settings_.stall_torque_Nm;  // closing is negative
  const bool still = absolute(toe.velocity_rad_s) < settings_.stall_speed_rad_s;
  stalled_s_ = pushing && still ? stalled_s_ + period_s_ : 0.0f;
  command = {.velocity_rad_s = -settings_.speed_rad_s, .kd_Nm_s_rad = settings_.kd_Nm_s_rad};
  if (stalled_s_ >= settings_.stall_time_s) {
    zero_rad_ = toe.position_rad - settings_.stop_angle_rad;
    return HomingResult::kFound;
  }
  return elapsed_s_ < settings_.timeout_s ? HomingResult::kSeeking : HomingResult::kFailed;
}

}  // namespace hoof::firmware::control
