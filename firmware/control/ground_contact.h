// What the leg feels of the sand: force, touch-down and sinkage, from drive torques alone.
#pragma once

#include "firmware/control/leg_dynamics.h"

namespace hoof::firmware::control {

struct GroundEstimate {
  bool valid = false;  // needs hip and knee
  bool contact = false;
  PlaneVector force_N;     // sand on foot, filtered
  float sinkage_m = 0.0f;  // sole point below its height at touch-down; 0 without contact
};

/// Force: what the measured torques lack of those that the motion alone needs is J^T F.
/// Contact: vertical force above a threshold for some ticks; a lower one ends it.
/// Sinkage: fall of the sole point since the force first passed the threshold. It knows nothing of
/// sand that was pushed up or dug away since, and is blind to the first newtons (25 N by default,
/// well under a millimetre for feet that need 14 to 50 N for each).
class GroundContact {
 public:
  GroundContact(const ContactSettings& settings, const LegKinematics& kinematics,
                const LegDynamics& dynamics);

  void reset();

  /// @param acceleration_rad_s2 commanded one: measured speed is too coarse to differentiate
  const GroundEstimate& update(LegAngles q, LegAngles velocity_rad_s, LegAngles acceleration_rad_s2,
                               LegAngles torque_Nm, float dt_s);

  const GroundEstimate& estimate() const { return estimate_; }

 private:
  void detect(float foot_z_m, float dt_s);

  ContactSettings settings_;
  LegKinematics kinematics_;
  LegDynamics dynamics_;
  GroundEstimate estimate_;
  float above_s_ = 0.0f;
  float touch_z_m_ = 0.0f;
};

}  // namespace hoof::firmware::control
