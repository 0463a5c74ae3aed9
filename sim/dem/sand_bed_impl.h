// The engine behind SandBed, once per precision.
#pragma once

#include "sim/dem/boundary.h"
#include "sim/dem/domain.h"
#include "sim/dem/neighbour_list.h"
#include "sim/dem/sand_bed.h"
#include "sim/dem/thread_team.h"

namespace hoof::sim {

struct SandBed::Impl {
  explicit Impl(const DemSettings& s);
  virtual ~Impl() = default;

  virtual void load(const BedState& state) = 0;
  virtual BedState state() const = 0;
  virtual void step() = 0;
  virtual std::size_t grain_count() const = 0;
  virtual void set_laws() = 0;
  virtual double coordination_number() const = 0;
  virtual double kinetic_energy_J() const = 0;
  virtual Eigen::Vector3d momentum_kg_m_s() const = 0;
  virtual std::uint64_t state_hash() const = 0;

  DemSettings settings;
  Domain domain;
  Boundary boundary;
  ThreadTeam team;
  BedHealth health;
  double interval_time_s = 0;  // since the last set_motion
};

template <typename Real>
struct SandBed::ImplOf final : SandBed::Impl {
  using Record = GrainRecord<Real>;
  using Records = typename NeighbourList<Real>::Records;

  explicit ImplOf(const DemSettings& s);

  void load(const BedState& state) override;
  BedState state() const override;
  void step() override;
  std::size_t grain_count() const override { return count; }
  void set_laws() override;
  double coordination_number() const override;
  double kinetic_energy_J() const override;
  Eigen::Vector3d momentum_kg_m_s() const override;
  std::uint64_t state_hash() const override;

 private:
  StepArguments<Real> arguments();
  void rebuild_if_stale();
  void rebuild_lists();
  double largest_displacement_m();
  void check(double fastest_m_s);
  Record to_record(const Grain& g) const;
  void store_contacts(const std::vector<GrainContact>& contacts);
  std::vector<std::uint32_t> rows_by_id() const;

  std::uint32_t count = 0;
  double largest_radius_m = 0;
  Records now, next;
  NeighbourList<Real> list;
  std::vector<std::array<std::int32_t, 3>> listed_at;  // positions at the last sort
  std::vector<std::uint32_t> part;                     // first group of each member
  PairLaw<Real> law{};
  StepKernel<Real> kernel = nullptr;
  double grain_travel_m = 0;  // no grain can have moved further since the last sort
};

}  // namespace hoof::sim
