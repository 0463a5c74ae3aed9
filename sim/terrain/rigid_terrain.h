// A level, hard floor: the ground with which control is tried out fast, and against which the
// multibody side is tested.
#pragma once

#include <vector>

#include "sim/config/reader.h"
#include "sim/terrain/terrain.h"

namespace hoof::sim {

/// Each vertex of a body below the surface is a contact: a spring and damper upward, and a spring
/// with Coulomb's limit along the surface.
struct RigidTerrainSettings {
  double surface_height_m = 0.0;
  /// Of one vertex.
  double stiffness_N_m = 0.0;
  double damping_N_s_m = 0.0;
  /// Stiffness along the surface over that across.
  double tangential_ratio = 0.0;
  double friction = 0.0;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;
};

/// Reads the section "rigid_terrain".
RigidTerrainSettings read_rigid_terrain(Reader section);

/// Wrenches are those at the end of the interval, not means over it: with the rig's semi-implicit
/// step this neither makes nor loses energy (a mean would lag by half an interval more). Stable
/// while (sum of stiffness / mass of the foot)^1/2 times the interval stays below 1.
class RigidTerrain final : public Terrain {
 public:
  explicit RigidTerrain(const RigidTerrainSettings& settings);

  int add_body(const TriangleMesh& mesh, const Pose& pose) override;
  void advance(double interval_s, std::span<const BodyMotion> motions,
               std::span<Wrench> wrenches) override;
  WrenchTime wrench_time() const override { return WrenchTime::kEndOfInterval; }
  double surface_height_m() const override { return settings_.surface_height_m; }
  double work_on_bodies_J() const override { return work_J_; }

 private:
  struct Contact {
    Eigen::Vector3d vertex_B_m = Eigen::Vector3d::Zero();
    /// Stretch of the spring along the surface.
    Eigen::Vector2d stretch_m = Eigen::Vector2d::Zero();
    Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
  };

  Eigen::Vector3d contact_force_N(Contact& contact, const Eigen::Vector3d& point_W_m,
                                  const Eigen::Vector3d& moved_W_m, double interval_s) const;

  RigidTerrainSettings settings_;
  std::vector<std::vector<Contact>> bodies_;
  double work_J_ = 0.0;
};

}  // namespace hoof::sim
