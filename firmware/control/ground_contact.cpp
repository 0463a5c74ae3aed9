#include "firmware/control/ground_contact.h"

namespace hoof::firmware::control {

GroundContact::GroundContact(const ContactSettings& settings, const LegKinematics& kinematics,
                             const LegDynamics& dynamics)
    : settings_(settings), kinematics_(kinematics), dynamics_(dynamics) {}

void GroundContact::reset() {
  estimate_ = {};
  above_s_ = 0.0f;
  feigned_N_ = 0.0f;
}

const GroundEstimate& GroundContact::update(const LegPosture& p, LegAngles velocity_rad_s,
                                            LegAngles acceleration_rad_s2, LegAngles torque_Nm,
                                            float dt_s) {
  estimate_.valid = true;
  feel_force(p, velocity_rad_s, acceleration_rad_s2, torque_Nm, dt_s);
  detect(p.foot_m, dt_s);
  measure_way(p.foot_m);
  measure_slip(-kinematics_.foot_velocity_m_s(p, velocity_rad_s).x, dt_s);
  return estimate_;
}

void GroundContact::feel_force(const LegPosture& p, LegAngles velocity_rad_s,
                               LegAngles acceleration_rad_s2, LegAngles torque_Nm, float dt_s) {
  const LegAngles model = dynamics_.torque_Nm(p.sines, velocity_rad_s, acceleration_rad_s2);
  const PlaneVector force = kinematics_.foot_force_N(
      p, {model.hip_rad - torque_Nm.hip_rad, model.knee_rad - torque_Nm.knee_rad});
  const float share = dt_s / (settings_.filter_s + dt_s);  // first-order low pass
  estimate_.force_N.x += share * (force.x - estimate_.force_N.x);
  estimate_.force_N.z += share * (force.z - estimate_.force_N.z);
  feigned_N_ += share * (friction_force_N(p, velocity_rad_s) - feigned_N_);
}

/// Vertical force of the worst signs of the friction that the model may have wrong.
float GroundContact::friction_force_N(const LegPosture& p, LegAngles velocity_rad_s) const {
  const LegAngles doubt = dynamics_.friction_doubt_Nm(velocity_rad_s);
  return absolute(kinematics_.foot_force_N(p, {doubt.hip_rad, 0.0f}).z) +
         absolute(kinematics_.foot_force_N(p, {0.0f, doubt.knee_rad}).z);
}

void GroundContact::detect(PlaneVector foot_m, float dt_s) {
  const float force_N = estimate_.force_N.z - feigned_N_;
  const bool holds =
      force_N >= (estimate_.contact ? settings_.release_force_N : settings_.touch_force_N);
  if (!holds) {
    estimate_.contact = false;
    above_s_ = 0.0f;
    return;
  }
  if (above_s_ == 0.0f) {
    touch_m_ = foot_m;
    body_way_m_ = 0.0f;
  } else {
    body_way_m_ += settings_.body_speed_m_s * dt_s;
  }
  above_s_ += dt_s;
  estimate_.contact = estimate_.contact || above_s_ >= settings_.hold_s;
}

void GroundContact::measure_way(PlaneVector foot_m) {
  const float fall_m = touch_m_.z - foot_m.z;
  estimate_.sinkage_m = estimate_.contact && fall_m > 0.0f ? fall_m : 0.0f;
  const float back_m = touch_m_.x - foot_m.x - body_way_m_;
  estimate_.slip_m = estimate_.contact ? back_m : 0.0f;
}

/// Speed is filtered before the division, which would turn its noise into a bias. The filter begins
/// with the speed at touch-down.
void GroundContact::measure_slip(float backward_m_s, float dt_s) {
  const float share = above_s_ > dt_s ? dt_s / (settings_.slip_filter_s + dt_s) : 1.0f;
  backward_m_s_ += share * (backward_m_s - backward_m_s_);
  estimate_.slip_valid = estimate_.contact && backward_m_s_ > settings_.slip_speed_m_s;
  estimate_.slip_ratio = estimate_.slip_valid
                             ? clamp(1.0f - settings_.body_speed_m_s / backward_m_s_, -1.0f, 1.0f)
                             : 0.0f;
}

}  // namespace hoof::firmware::control
