// Rigid bodies and joints of the Open Dynamics Engine behind plain classes.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/multibody/mass_properties.h"
#include "sim/terrain/terrain.h"

struct dxBody;
struct dxJoint;
struct dxThreadingImplementation;
struct dxWorld;

namespace hoof::sim {

/// Owns all bodies and joints made in it. Steps with the direct solver (dWorldStep), which is
/// deterministic; the iterative one draws random numbers. Worlds share nothing: each thread may
/// step one of its own.
class OdeWorld {
 public:
  explicit OdeWorld(const Eigen::Vector3d& gravity_m_s2);
  ~OdeWorld();
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;

  void step(double interval_s);
  dxWorld* handle() { return world_; }

 private:
  dxWorld* world_;
  dxThreadingImplementation* threading_;
};

/// A rigid body known by its frame B, which need not be at the centre of mass.
class OdeBody {
 public:
  OdeBody(OdeWorld& world, const MassProperties& mass, const Pose& pose);

  Pose pose() const;
  /// Of the origin of B.
  Eigen::Vector3d velocity_m_s() const;
  Eigen::Vector3d angular_velocity_rad_s() const;
  Eigen::Vector3d com_W_m() const;
  const MassProperties& mass() const { return mass_; }
  double kinetic_J() const;

  void apply_force_at_com(const Eigen::Vector3d& force_W_N);
  void apply_torque(const Eigen::Vector3d& torque_W_Nm);
  /// Torque about the origin of B.
  void apply_wrench(const Wrench& wrench);

  /// From now on moved by move_kinematic() alone, whatever acts on it.
  void make_kinematic();
  /// Gives the velocity that reaches the pose after interval_s.
  void move_kinematic(const Pose& target, double interval_s);

  dxBody* handle() { return body_; }

 private:
  dxBody* body_;
  MassProperties mass_;
};

/// A turning joint between a body and another one (or the world, null). The angle starts at
/// `angle_rad` and grows when `moving` turns about the axis by the right-hand rule.
class OdeHinge {
 public:
  OdeHinge(OdeWorld& world, OdeBody& moving, OdeBody* base, const Eigen::Vector3d& anchor_W_m,
           const Eigen::Vector3d& axis_W, double angle_rad);

  double angle_rad() const;
  double rate_rad_s() const;
  /// On the moving body, the opposite on its base.
  void apply_torque(double torque_Nm);
  /// Hard, without rebound.
  void set_stops(double min_rad, double max_rad);

 private:
  dxJoint* joint_;
  double offset_rad_;
};

/// A body that can only move along an axis fixed in the world.
class OdeSlider {
 public:
  OdeSlider(OdeWorld& world, OdeBody& moving, const Eigen::Vector3d& axis_W);

  /// Enforces this speed along the axis with any force it takes.
  void drive(double speed_m_s);
  void release();

 private:
  dxJoint* joint_;
};

}  // namespace hoof::sim
