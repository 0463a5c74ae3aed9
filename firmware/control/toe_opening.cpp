#include "firmware/control/toe_opening.h"

#include "firmware/control/leg_dynamics.h"

namespace hoof::firmware::control {

ToeOpening::ToeOpening(const ToeSettings& settings, float period_s)
    : settings_(settings), period_s_(period_s), generator_(period_s) {
  input_.set_limits(0, settings.speed_rad_s, settings.acceleration_rad_s2, settings.jerk_rad_s3);
  generator_.set_work_per_update(kPlanningUnitsPerTick);
}

void ToeOpening::start(float measured_rad) {
  generator_.reset();
  input_.position = {measured_rad};
  target_rad_ = measured_rad;
  set_point_ = {};
  set_point_.position = {measured_rad};
  moving_ = halting_ = planless_ = false;
  arrived_ = true;
  arrived_rad_ = measured_rad;
  jam_s_ = stuck_s_ = 0.0f;
}

/// A change smaller than the distance of a jam, ordered while a load holds the toe off its target,
/// could not be told from the load: it is not watched.
void ToeOpening::move_to(float angle_rad) {
  target_rad_ = angle_rad;
  halting_ = false;
  if (absolute(angle_rad - arrived_rad_) > settings_.jam_distance_rad) arrived_ = false;
}

JointCommand ToeOpening::step(const JointState& toe) {
  advance_set_point();
  watch_move(toe);
  const float velocity_rad_s = set_point_.velocity[0];
  return {.position_rad = set_point_.position[0],
          .velocity_rad_s = velocity_rad_s,
          .kp_Nm_rad = settings_.kp_Nm_rad,
          .kd_Nm_s_rad = settings_.kd_Nm_s_rad,
          .torque_Nm = settings_.inertia_kg_m2 * set_point_.acceleration[0] +
                       smooth_friction_Nm(settings_.friction_Nm,
                                          settings_.viscous_friction_Nm_s_rad, velocity_rad_s)};
}

void ToeOpening::advance_set_point() {
  using trajectory::Interface;
  using trajectory::Result;
  input_.interface = halting_ ? Interface::kVelocity : Interface::kPosition;
  input_.target_position = {target_rad_};
  const Result result = generator_.update(input_, set_point_);
  planless_ = trajectory::is_failure(result);
  if (halting_ && (result == Result::kFinished || result == Result::kHolding)) {
    halting_ = false;
    target_rad_ = set_point_.position[0];
  }
  // While a plan is being made the generator still tells of the old one.
  const bool elsewhere = set_point_.position[0] != target_rad_;
  moving_ = !planless_ && (result == Result::kWorking || elsewhere);
}

/// What counts is how far the toe is behind its set point: with the target, a slow move against a
/// load would look like a jam. The set point goes on, so whoever stands still falls behind.
void ToeOpening::watch_move(const JointState& toe) {
  constexpr float kStandstill_rad_s = 0.06f;  // three codes of the reply's velocity
  const auto near = [&](float angle_rad) {
    return absolute(angle_rad - toe.position_rad) <= settings_.jam_distance_rad;
  };
  if (!moving_ && near(target_rad_)) {
    arrived_ = true;
    arrived_rad_ = target_rad_;
  }
  const bool still = absolute(toe.velocity_rad_s) < kStandstill_rad_s;
  const bool stuck = !arrived_ && still && !near(set_point_.position[0]);
  const bool pushing = absolute(toe.torque_Nm) >= settings_.jam_torque_Nm;
  stuck_s_ = stuck ? stuck_s_ + period_s_ : 0.0f;
  jam_s_ = stuck && pushing ? jam_s_ + period_s_ : 0.0f;
}

/// way/v + v/a + a/j is the duration where speed and acceleration reach their limits. Where they do
/// not, it is longer than that by up to w^2 / (4 a v), w = a^2/j <= v, or 0.19 a/j (speed without
/// ever reaching a): a/(4 j) covers all. A plan under way has to be finished before the move's own,
/// and a tick goes by before either.
float ToeOpening::longest_move_s(float way_rad) const {
  using Planner = trajectory::Planner<float, 1>;
  constexpr int kUnits = Planner::usual_units(1, trajectory::Synchronisation::kTime);
  constexpr int kPlan = kUnits / kPlanningUnitsPerTick + 1;
  const float v = settings_.speed_rad_s;
  const float a = settings_.acceleration_rad_s2;
  return way_rad / v + v / a + 1.25f * a / settings_.jerk_rad_s3 +
         static_cast<float>(2 * (kPlan + 1)) * period_s_;
}

}  // namespace hoof::firmware::control
