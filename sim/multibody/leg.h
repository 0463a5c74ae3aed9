// The two-link leg: its numbers and its kinematics.
#pragma once

#include "sim/config/reader.h"

namespace hoof::sim {

struct Link {
  double length_m = 0.0;
  double mass_kg = 0.0;
  /// Centre of mass below the upper joint.
  double com_from_joint_m = 0.0;
  /// Radius of gyration about the centre of mass, in the plane of motion.
  double gyration_m = 0.0;
};

/// The hip is at x = 0, z = hip_height_m of the world; the shank ends in the middle of the sole.
struct Leg {
  Link thigh;
  Link shank;
  double hip_height_m = 0.0;
  /// Where the sole is level: the middle of the sole at x = 0 and this height. It fixes the angle
  /// between shank and foot.
  double level_sole_z_m = 0.0;
  /// Mechanical end stops.
  double hip_min_rad = 0.0;
  double hip_max_rad = 0.0;
  double knee_min_rad = 0.0;
  double knee_max_rad = 0.0;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;
};

/// Hip: thigh from straight down, positive forward. Knee: shank from the thigh's line, positive
/// forward; the knee bends backward like a bird's or goat's hock, so it is never above zero.
struct LegAngles {
  double hip_rad = 0.0;
  double knee_rad = 0.0;
};

struct LegPoint {
  double x_m = 0.0;
  double z_m = 0.0;
  /// Sole about -y: positive when its front points up.
  double pitch_rad = 0.0;
};

struct LegTorques {
  double hip_Nm = 0.0;
  double knee_Nm = 0.0;
};

/// Middle of the sole in the world frame.
LegPoint forward_kinematics(const Leg& leg, const LegAngles& angles);

/// @throws std::invalid_argument where the point is out of reach
LegAngles inverse_kinematics(const Leg& leg, double x_m, double z_m);

/// Joint torques that hold a force on the middle of the sole at rest, tau = -J^T f, weight of the
/// links not included.
LegTorques holding_torques(const Leg& leg, const LegAngles& angles, double fx_N, double fz_N);

/// Reads the section "leg" of a run.
Leg read_leg(Reader section);

}  // namespace hoof::sim
