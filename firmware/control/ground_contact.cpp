#include "firmware/control/ground_contact.h"

namespace hoof::firmware::control {

GroundContact::GroundContact(const ContactSettings& settings, const LegKinematics& kinematics,
                             const LegDynamics& dynamics)
    : settings_(settings), kinematics_(kinematics), dynamics_(dynamics) {}

void GroundContact::reset() {
  estimate_ = {};
  above_s_ = 0.0f;
}

const GroundEstimate& GroundContact::update(LegAngles q, LegAngles velocity_rad_s,
                                            LegAngles acceleration_rad_s2, LegAngles torque_Nm,
                                            float dt_s) {
  const LegAngles model = dynamics_.torque_Nm(q, velocity_rad_s, acceleration_rad_s2);
  const PlaneVector force = kinematics_.foot_force_N(
      q, {model.hip_rad - torque_Nm.hip_rad, model.knee_rad - torque_Nm.knee_rad});
  const float share = dt_s / (settings_.filter_s + dt_s);  // first-order low pass
  estimate_.force_N.x += share * (force.x - estimate_.force_N.x);
  estimate_.force_N.z += share * (force.z - estimate_.force_N.z);
  estimate_.valid = true;
  detect(kinematics_.foot_m(q).z, dt_s);
  return estimate_;
}

void GroundContact::detect(float foot_z_m, float dt_s) {
  const float force_N = estimate_.force_N.z;
  if (estimate_.contact) {
    if (force_N < settings_.release_force_N) {
      estimate_.contact = false;
      above_s_ = 0.0f;
    }
  } else if (force_N < settings_.touch_force_N) {
    above_s_ = 0.0f;
  } else {
    if (above_s_ == 0.0f) touch_z_m_ = foot_z_m;
    above_s_ += dt_s;
    estimate_.contact = above_s_ >= settings_.hold_s;
  }
  const float fall_m = touch_z_m_ - foot_z_m;
  estimate_.sinkage_m = estimate_.contact && fall_m > 0.0f ? fall_m : 0.0f;
}

}  // namespace hoof::firmware::control
