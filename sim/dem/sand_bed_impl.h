// The engine behind SandBed, once per precision.
#pragma once

#include <atomic>

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
  virtual BedState state(const Eigen::AlignedBox3d* region_m) const = 0;  // null: everywhere
  virtual std::vector<MeshTouch> mesh_touches() const = 0;
  virtual void step() = 0;
  virtual std::size_t grain_count() const = 0;
  virtual void set_laws() = 0;
  virtual double coordination_number() const = 0;
  virtual double kinetic_energy_J() const = 0;
  virtual Eigen::Vector3d momentum_kg_m_s() const = 0;
  virtual std::uint64_t state_hash() const = 0;
  virtual EnergyBalance energy() const = 0;
  virtual std::size_t memory_bytes() const = 0;
  virtual void save(ByteWriter& out) const = 0;
  virtual void restore(ByteReader& in) = 0;

  DemSettings settings;
  Domain domain;
  Boundary boundary;
  ThreadTeam team;
  BedHealth health;
  double interval_time_s = 0;  // since the last set_motion
  EnergyBalance lost;          // since the start; only its losses and works
};

template <typename Real>
struct SandBed::ImplOf final : SandBed::Impl {
  using Record = GrainRecord<Real>;
  using Records = typename NeighbourList<Real>::Records;

  explicit ImplOf(const DemSettings& s);

  void load(const BedState& state) override;
  BedState state(const Eigen::AlignedBox3d* region_m) const override;
  std::vector<MeshTouch> mesh_touches() const override;
  void step() override;
  std::size_t grain_count() const override { return count; }
  void set_laws() override;
  double coordination_number() const override;
  double kinetic_energy_J() const override;
  Eigen::Vector3d momentum_kg_m_s() const override;
  std::uint64_t state_hash() const override;
  EnergyBalance energy() const override;
  std::size_t memory_bytes() const override;
  void save(ByteWriter& out) const override;
  void restore(ByteReader& in) override;

 private:
  struct alignas(64) Cursor {  // next window of one member's share
    std::atomic<std::uint32_t> next{0};
  };

  StepArguments<Real> arguments(bool account);
  bool is_audit_due() const;
  double fitting_skin_m();
  void refresh_lists();
  void sort_lists(double skin_m);
  void share_out();
  void compute_forces(const StepArguments<Real>& a);
  void share_windows(int member, const std::function<void(std::uint32_t, std::uint32_t)>& work);
  void take_results();
  void check_speed(double fastest_m_s);
  void check_load(const WindowResult& worst);
  void check_places();
  std::string grain_text(std::uint32_t row) const;
  Record to_record(const Grain& g) const;
  Record padding() const;
  void store_contacts(const std::vector<GrainContact>& contacts);
  std::vector<std::uint32_t> rows_by_id(const Eigen::AlignedBox3d* region_m = nullptr) const;
  double kinetic_energy_J(const Records& records) const;

  std::uint32_t count = 0;
  double largest_radius_m = 0, smallest_radius_m = 0;
  Records now, next;  // next also holds the step before, once there was one
  NeighbourList<Real> list;
  std::vector<WindowResult> results;  // of the last step
  std::vector<std::uint32_t> share;   // first window of each member
  std::unique_ptr<Cursor[]> cursors;
  PairLaw<Real> law{};
  StepKernel<Real> kernel = nullptr;
};

}  // namespace hoof::sim
