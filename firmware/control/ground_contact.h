// What the leg feels of the sand: force, touch-down, sinkage and slip, from its drives alone.
#pragma once

#include "firmware/control/leg_dynamics.h"

namespace hoof::firmware::control {

struct GroundEstimate {
  bool valid = false;  // needs hip and knee
  bool contact = false;
  PlaneVector force_N;      // sand on foot, filtered
  float sinkage_m = 0.0f;   // sole point below its height at touch-down; 0 without contact
  float slip_m = 0.0f;      // sole point backwards through the ground since touch-down; 0 without
  bool slip_valid = false;  // in contact, and the foot fast enough for a ratio
  float slip_ratio = 0.0f;  // -1 to 1, positive driving; 0 where not valid
};

/// Force: what the measured torques lack of those that the motion alone needs is J^T F.
/// Contact: vertical force above a threshold for some ticks; a lower one ends it. Both lie above
/// the force that friction may feign: 5 N where the joints move with 0.5 rad/s, 53 N at rest (4.8
/// Nm in both drives, leg nearly stretched). Sinkage: fall of the sole point since the force first
/// passed the threshold. It knows nothing of sand that was pushed up or dug away since, of a hip
/// that rises or falls, and is blind to the first newtons, up to the threshold.
///
/// Slip, by the convention of driven wheels (Wong, Theory of Ground Vehicles: i = 1 - V / (r w)):
/// with x the sole point ahead of the hip, u = -dx/dt its speed backwards and V the hip's speed
/// over ground, slip_ratio = 1 - V / u and slip_m = -(x - x_touch) - V t. Positive: the foot goes
/// back through the ground, driving; 1 on a held hip. Negative: it is dragged forward, braking;
/// Wong's skid divides by V instead, here the ratio ends at -1. V is told, not measured: an error
/// of it is an error of the slip, by 1/u and by t. Slip of the sand itself under a foot that holds
/// is not seen, nor is any sideways.
class GroundContact {
 public:
  GroundContact(const ContactSettings& settings, const LegKinematics& kinematics,
                const LegDynamics& dynamics);

  void reset();

  /// @param acceleration_rad_s2 commanded one: measured speed is too coarse to differentiate
  const GroundEstimate& update(const LegPosture& p, LegAngles velocity_rad_s,
                               LegAngles acceleration_rad_s2, LegAngles torque_Nm, float dt_s);
  const GroundEstimate& update(LegAngles q, LegAngles velocity_rad_s, LegAngles acceleration_rad_s2,
                               LegAngles torque_Nm, float dt_s) {
    return update(kinematics_.posture(q), velocity_rad_s, acceleration_rad_s2, torque_Nm, dt_s);
  }

  const GroundEstimate& estimate() const { return estimate_; }

 private:
  void feel_force(const LegPosture& p, LegAngles velocity_rad_s, LegAngles acceleration_rad_s2,
                  LegAngles torque_Nm, float dt_s);
  void detect(PlaneVector foot_m, float dt_s);
  float friction_force_N(const LegPosture& p, LegAngles velocity_rad_s) const;
  void measure_way(PlaneVector foot_m);
  void measure_slip(float backward_m_s, float dt_s);

  ContactSettings settings_;
  LegKinematics kinematics_;
  LegDynamics dynamics_;
  GroundEstimate estimate_;
  float feigned_N_ = 0.0f;     // by friction at most, filtered
  float above_s_ = 0.0f;       // since the force passed the threshold
  PlaneVector touch_m_;        // sole point then
  float body_way_m_ = 0.0f;    // of the hip over ground since then
  float backward_m_s_ = 0.0f;  // filtered
};

}  // namespace hoof::firmware::control
