// What carries the foot: bodies that touch the ground and the joints that drives act on.
#pragma once

#include <Eigen/Core>
#include <span>

#include "sim/dem/triangle_mesh.h"
#include "sim/terrain/terrain.h"

namespace hoof::sim {

/// The driven joints, numbered as the firmware numbers its drives.
enum class Joint { kToe = 0, kHip = 1, kKnee = 2 };
inline constexpr int kJointCount = 3;

constexpr const char* joint_name(Joint joint) {
  constexpr const char* kNames[kJointCount] = {"toe", "hip", "knee"};
  return kNames[static_cast<int>(joint)];
}

/// Mechanical energy of a rig, J.
struct RigEnergy {
  double kinetic_J = 0.0;
  /// Of gravity, zero at the height of the world origin.
  double gravity_J = 0.0;
  /// Of the linkage that keeps the two toes symmetric.
  double linkage_J = 0.0;

  double total_J() const { return kinetic_J + gravity_J + linkage_J; }
};

/// Bodies are numbered 0 = middle segment (frame F), 1 = left toe (T0), 2 = right toe (T1); a foot
/// without toes has body 0 alone. Torques and wrenches are held for the next step() and then
/// forgotten.
class Rig {
 public:
  virtual ~Rig() = default;

  virtual int body_count() const = 0;
  /// Surface of a body in its own frame.
  virtual const TriangleMesh& mesh(int body) const = 0;
  virtual Pose pose(int body) const = 0;

  /// Joints present on this rig, in the order of their numbers.
  virtual std::span<const Joint> joints() const = 0;
  /// Toe: mean outward opening of both toes from straight ahead. Hip: thigh from straight down,
  /// positive forward. Knee: shank from the thigh's line, positive forward (bent knee: negative).
  virtual double joint_position_rad(Joint joint) const = 0;
  virtual double joint_velocity_rad_s(Joint joint) const = 0;
  virtual void apply_joint_torque(Joint joint, double torque_Nm) = 0;

  /// Force and torque of the ground on a body, torque about the origin of the body's frame.
  virtual void apply_wrench(int body, const Wrench& wrench) = 0;

  virtual void step(double interval_s) = 0;

  virtual RigEnergy energy() const = 0;

  /// Middle of the sole (origin of F), world frame.
  Eigen::Vector3d foot_position_m() const { return pose(0).p_WB_m; }
  virtual Eigen::Vector3d foot_velocity_m_s() const = 0;

  /// Opening of one toe, positive outward; toe 0 is left (+y), 1 is right.
  virtual double toe_opening_rad(int toe) const = 0;
};

}  // namespace hoof::sim
