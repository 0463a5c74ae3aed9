// The DEM engine: grains, walls and moving meshes under gravity.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/dem/boundary.h"
#include "sim/dem/contact_energy.h"
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
  // Neighbours are listed this far beyond touch; 0: chosen while running, the wider the more the
  // sand moves. The choice changes speed, and the order of sums, but no physics.
  double skin_m = 0;
  double cell_m = 0;            // of the search for neighbours; 0: 1.6 times the largest radius
  double viscous_rate_1_s = 0;  // velocities decay at this rate; only while a bed is made
  bool account_energy = false;  // every step, for energy(); costs about a third of the speed
  int audit_steps = 500;        // overlaps and stiffness are looked at this often; 0: never
  Precision precision = Precision::kMixed;
  int threads = 1;
  InstructionSet instruction_set = best_instruction_set();

  /// @throws std::invalid_argument naming the first broken rule, its value and bound
  void validate() const;
};

struct BedHealth {
  double time_s = 0;
  std::uint64_t steps = 0;
  std::uint64_t rebuilds = 0;         // of all lists
  std::uint64_t renewed = 0;          // grains whose neighbours were looked up between rebuilds
  double fastest_m_s = 0;             // in the last step
  double deepest_boundary_ratio = 0;  // overlap with walls and meshes over grain radius, so far
  // At the last audit:
  double deepest_ratio = 0;  // overlap of two grains over the smaller one's radius
  double step_ratio = 0;     // step over the stability bound 2 sqrt(m/k) of the stiffest held grain
};

/// Energies at the last step, J. What went in less what was lost less what is there: `residual_J`,
/// the error of the integration (and of what the model makes or loses: the tangential spring's
/// stiffness changes with the overlap; that is booked as tangential loss).
struct EnergyBalance {
  double kinetic_J = 0;
  double potential_J = 0;  // in gravity, about the domain's origin
  ContactEnergy grain_grain;
  ContactEnergy boundary;  // with walls and meshes
  double viscous_loss_J = 0;
  double work_by_meshes_J = 0;

  double present_J() const {
    return kinetic_J + potential_J + grain_grain.stored_J() + boundary.stored_J();
  }
  double lost_J() const { return grain_grain.lost_J() + boundary.lost_J() + viscous_loss_J; }
  /// Constant if all is right.
  double total_J() const { return present_J() + lost_J() - work_by_meshes_J; }
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

  /// n steps of dt. @throws std::runtime_error where the state blows up: step, grain, cause,
  /// setting to change.
  void advance(int steps);

  /// Impulse, angular impulse and work of the grains on mesh i since the last take.
  MeshLoad take_load(int mesh);

  BedState state() const;
  /// Only the grains whose centres lie in the region, and the contacts among these and with walls.
  BedState state(const Eigen::AlignedBox3d& region_m) const;
  /// Where grains touch meshes, by grain. After a step.
  std::vector<MeshTouch> mesh_touches() const;
  std::size_t grain_count() const;
  BedHealth health() const;
  const DemSettings& settings() const;

  /// Everything that decides the future, to the byte: a bed restored from it goes on as this one
  /// does, from any number of threads. Settings and meshes are not in it: the bed that takes it
  /// must have been made with the same.
  std::string snapshot() const;
  /// @throws std::runtime_error where the snapshot is damaged or of another bed
  void restore(std::string_view snapshot);

  /// Friction off and on while a bed is made. Contact histories stay.
  void set_contact_pairs(const PairCoefficients& grain_grain, const PairCoefficients& grain_wall);
  void set_viscous_rate(double rate_1_s);

  /// Needs settings.account_energy and one step at least.
  EnergyBalance energy() const;
  double kinetic_energy_J() const;
  Eigen::Vector3d momentum_kg_m_s() const;
  /// Mean number of touching partners per grain, walls and meshes not counted.
  double coordination_number() const;
  /// FNV-1a of all grain records by id: equal states, equal hashes.
  std::uint64_t state_hash() const;
  /// Held for grains and lists, without scratch that a rebuild frees again.
  std::size_t memory_bytes() const;

 private:
  struct Impl;
  template <typename Real>
  struct ImplOf;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hoof::sim
