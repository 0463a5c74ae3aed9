// Rig, drives and ground advanced together, one exchange interval after the other.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/coupling/coupling_settings.h"
#include "sim/drive/drive.h"
#include "sim/multibody/rig.h"
#include "sim/terrain/terrain.h"

namespace hoof::sim {

/// Energy at the exchange between rig and ground since the start, J. The ground's wrench of
/// interval n moves the rig in interval n + 1; what the rig receives and what the ground gave
/// differ by what is left of that lag.
struct ExchangeEnergy {
  double work_on_rig_J = 0.0;
  double work_by_terrain_J = 0.0;

  /// Positive: the exchange made energy. Negative: it lost some.
  double error_J() const { return work_on_rig_J - work_by_terrain_J; }
};

/// The drives of a plant by joint; a joint without a drive swings freely.
using DriveSet = std::array<std::optional<DriveSettings>, kJointCount>;

class Plant {
 public:
  /// Drives are made for those joints of the rig that have settings in `drives`.
  /// @throws std::invalid_argument for settings that validate() refuses
  Plant(std::unique_ptr<Rig> rig, const DriveSet& drives, std::unique_ptr<Terrain> terrain,
        const CouplingSettings& settings);

  /// One exchange interval: drives, then the rig under the wrenches of the interval before, then
  /// the ground under the motion of the bodies.
  /// @throws std::runtime_error when the motion diverges, with time, cause and the setting to
  /// change
  void advance();

  double time_s() const { return static_cast<double>(intervals_) * settings_.exchange_s; }
  const CouplingSettings& settings() const { return settings_; }

  Rig& rig() { return *rig_; }
  const Rig& rig() const { return *rig_; }
  Terrain& terrain() { return *terrain_; }
  const Terrain& terrain() const { return *terrain_; }
  /// Null where the rig has no such joint or the joint no drive.
  Drive* drive(Joint joint);
  const Drive* drive(Joint joint) const;

  /// Mean torque of the drive's gear on the joint in the last interval; 0 without a drive.
  double joint_torque_Nm(Joint joint) const { return torques_Nm_[static_cast<int>(joint)]; }

  /// Of the ground on each body in the last interval.
  std::span<const Wrench> wrenches() const { return wrenches_; }
  /// Of the ground on the whole foot in the last interval, world frame.
  Eigen::Vector3d ground_force_N() const;
  /// True once any body has felt a force.
  bool touched() const { return touched_; }
  /// True until the foot comes near the ground for the first time: the settled ground is not
  /// stepped before. Later never again, as sand that was moved may still be on its way.
  bool terrain_asleep() const { return asleep_; }

  ExchangeEnergy exchange_energy() const { return exchange_energy_; }

 private:
  void step_drives();
  void step_rig();
  Wrench prompt_wrench(std::size_t body) const;
  void step_terrain();
  bool far_above_m(double height_m) const;
  double lowest_point_m() const;
  void guard() const;
  [[noreturn]] void diverged(const std::string& cause) const;

  std::unique_ptr<Rig> rig_;
  std::unique_ptr<Terrain> terrain_;
  CouplingSettings settings_;
  std::array<std::optional<Drive>, kJointCount> drives_;
  std::array<double, kJointCount> torques_Nm_{};
  std::vector<BodyMotion> motions_;
  std::vector<Wrench> wrenches_;  // of the last interval
  std::vector<Wrench> before_;    // of the one before it
  std::int64_t intervals_ = 0;
  std::vector<double> reach_m_;  // of each body: its farthest vertex from its origin
  bool asleep_ = true;
  bool touched_ = false;
  ExchangeEnergy exchange_energy_;
};

}  // namespace hoof::sim
