// The DEM engine: grains, walls and moving meshes under gravity.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "sim/dem/boundary.h"
#include "sim/dem/contact_material.h"
#include "sim/dem/grain.h"
#include "sim/dem/step_kernel.h"

namespace hoof::sim {

enum class Precision { kMixed, kDouble };

struct DemSettings {
  // The domain. Along periodic axes it is the period; elsewhere leave room around the walls.
  Eigen::Vector3d low_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d high_m = Eigen::Vector3d::Zero();
  std::array<bool, 3> periodic{};
  std::vector<Wall> walls;

  ElasticMaterial grain_material;
  ElasticMaterial wall_material;  // of walls and meshes
  PairCoefficients grain_grain;
  PairCoefficients grain_wall;
  CoulombCap coulomb_cap = CoulombCap::kTotalNormal;
  RollingLaw rolling_law = RollingLaw::kOwnSpin;

  Eigen::Vector3d gravity_m_s2{0, 0, -9.81};
  double dt_s = 2.8e-6;
  double skin_m = 2e-4;         // neighbours are listed this far beyond touch
  double viscous_rate_1_s = 0;  // velocities decay at this rate; only while a bed is made
  Precision precision = Precision::kMixed;
  int threads = 1;
  InstructionSet instruction_set = best_instruction_set();

  /// @throws std::invalid_argument naming the first broken rule, its value and bound
  void validate() const;
};

struct BedHealth {
  double time_s = 0;
  std::uint64_t steps = 0;
  std::uint64_t rebuilds = 0;
  double fastest_m_s = 0;             // in the last step
  double deepest_boundary_ratio = 0;  // overlap with walls and meshes over grain radius, so far
};

class SandBed {
 public:
  /// @throws std::invalid_argument for settings or grains that cannot be
  SandBed(const DemSettings& settings, const BedState& state);
  ~SandBed();
  SandBed(SandBed&&) noexcept;

  int add_mesh(const TriangleMesh& mesh, const Eigen::Vector3d& p_WB_m,
               const Eigen::Quaterniond& q_WB);

  /// Until the next call mesh i moves at constant velocity from the given pose.
  void set_motion(int mesh, const MeshMotion& motion);

  /// n steps of dt. @throws std::runtime_error where the state blows up: step, cause, setting.
  void advance(int steps);

  /// Impulse, angular impulse and work of the grains on mesh i since the last take.
  MeshLoad take_load(int mesh);

  BedState state() const;
  std::size_t grain_count() const;
  BedHealth health() const;
  const DemSettings& settings() const;

  /// Friction off and on while a bed is made. Contact histories stay.
  void set_contact_pairs(const PairCoefficients& grain_grain, const PairCoefficients& grain_wall);
  void set_viscous_rate(double rate_1_s);

  double kinetic_energy_J() const;
  Eigen::Vector3d momentum_kg_m_s() const;
  /// Mean number of touching partners per grain, walls and meshes not counted.
  double coordination_number() const;
  /// FNV-1a of all grain records by id: equal states, equal hashes.
  std::uint64_t state_hash() const;

 private:
  struct Impl;
  template <typename Real>
  struct ImplOf;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hoof::sim
