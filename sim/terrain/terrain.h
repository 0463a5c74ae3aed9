// What a foot stands on: DEM grains, a rigid plane or a fast soil law, all behind one interface.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

/// Where a body is: world from body, p_WB in metres (origin of the mesh frame).
struct Pose {
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
};

/// A body's motion over one exchange interval: the terrain interpolates between the two poses.
struct BodyMotion {
  Pose start;
  Pose end;
};

/// Force and torque of the terrain on a body, world frame, torque about the body's origin p_WB.
struct Wrench {
  Eigen::Vector3d f_W_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d tau_Bo_W_Nm = Eigen::Vector3d::Zero();
};

/// What an interval's wrench stands for. A ground that is itself stepped gives the mean over the
/// interval, half an interval older than one that answers at its end.
enum class WrenchTime { kMeanOverInterval, kEndOfInterval };

class Terrain {
 public:
  virtual ~Terrain() = default;

  virtual WrenchTime wrench_time() const { return WrenchTime::kMeanOverInterval; }

  /// Adds a body; its index is the number of bodies before. Call before the first advance.
  virtual int add_body(const TriangleMesh& mesh, const Pose& pose) = 0;

  /// Advances the ground by `interval_s` while body i moves as motions[i] says.
  /// @param motions one per body  @param wrenches out, one per body
  virtual void advance(double interval_s, std::span<const BodyMotion> motions,
                       std::span<Wrench> wrenches) = 0;

  /// Height of the undisturbed surface above the world origin, m.
  virtual double surface_height_m() const = 0;

  /// Work done by the terrain on all bodies since the start, as the terrain integrated it, J.
  virtual double work_on_bodies_J() const = 0;
};

}  // namespace hoof::sim
