#include "sim/dem/sand_bed.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/dem/sand_bed_impl.h"

namespace hoof::sim {
namespace {

void require(bool ok, const std::string& rule) {
  if (!ok) throw std::invalid_argument("bed: " + rule);
}

BoundarySettings boundary_settings(const DemSettings& s) {
  return {make_pair_law(s.grain_material, s.wall_material, s.grain_wall),
          s.coulomb_cap,
          s.rolling_law,
          s.walls,
          s.skin_m,
          s.account_energy};
}

void require_pair(const PairCoefficients& pair, const std::string& name) {
  require(pair.restitution > 0 && pair.restitution <= 1,
          name + ".restitution = " + std::to_string(pair.restitution) + ", must be in (0, 1]");
  require(pair.static_friction >= 0, name + ".static_friction must not be negative");
  require(pair.rolling_friction >= 0, name + ".rolling_friction must not be negative");
}

}  // namespace

void DemSettings::validate() const {
  require((high_m - low_m).minCoeff() > 0, "the domain must have a positive size");
  require(dt_s > 0, "dt_s = " + std::to_string(dt_s) + ", must be positive");
  require(skin_m >= 0, "skin_m = " + std::to_string(skin_m) + ", must not be negative");
  require(cell_m >= 0, "cell_m = " + std::to_string(cell_m) + ", must not be negative");
  require(viscous_rate_1_s >= 0 && viscous_rate_1_s * dt_s < 1,
          "viscous_rate_1_s must be at least 0 and under 1 / dt_s");
  require(walls.size() <= 32, "at most 32 walls");
  require(threads >= 1, "threads = " + std::to_string(threads) + ", must be at least 1");
  require_pair(grain_grain, "grain_grain");
  require_pair(grain_wall, "grain_wall");
  for (const Wall& w : walls) {
    require(std::abs(w.normal.norm() - 1) < 1e-9, "a wall's normal must have length 1");
  }
}

SandBed::Impl::Impl(const DemSettings& s)
    : settings(s),
      domain(Domain::spanning(s.low_m, s.high_m, s.periodic)),
      boundary(boundary_settings(s)),
      team(s.threads) {}

SandBed::SandBed(const DemSettings& settings, const BedState& state) {
  settings.validate();
  if (settings.precision == Precision::kDouble) {
    impl_ = std::make_unique<ImplOf<double>>(settings);
  } else {
    impl_ = std::make_unique<ImplOf<float>>(settings);
  }
  impl_->load(state);
}

SandBed::~SandBed() = default;
SandBed::SandBed(SandBed&&) noexcept = default;

int SandBed::add_mesh(const TriangleMesh& mesh, const Eigen::Vector3d& p_WB_m,
                      const Eigen::Quaterniond& q_WB) {
  const int index = impl_->boundary.add_mesh(mesh);
  impl_->boundary.set_motion(index, {p_WB_m, q_WB});
  return index;
}

void SandBed::set_motion(int mesh, const MeshMotion& motion) {
  impl_->boundary.set_motion(mesh, motion);
  impl_->interval_time_s = 0;
}

void SandBed::advance(int steps) {
  for (int i = 0; i < steps; ++i) impl_->step();
}

MeshLoad SandBed::take_load(int mesh) {
  const MeshLoad load = impl_->boundary.take_load(mesh);
  impl_->lost.work_by_meshes_J -= load.work_J;
  return load;
}
BedState SandBed::state() const {
  return impl_->state(nullptr);
}
BedState SandBed::state(const Eigen::AlignedBox3d& region_m) const {
  return impl_->state(&region_m);
}
std::vector<MeshTouch> SandBed::mesh_touches() const {
  return impl_->mesh_touches();
}
std::size_t SandBed::grain_count() const {
  return impl_->grain_count();
}
const DemSettings& SandBed::settings() const {
  return impl_->settings;
}
double SandBed::kinetic_energy_J() const {
  return impl_->kinetic_energy_J();
}
Eigen::Vector3d SandBed::momentum_kg_m_s() const {
  return impl_->momentum_kg_m_s();
}
double SandBed::coordination_number() const {
  return impl_->coordination_number();
}
EnergyBalance SandBed::energy() const {
  return impl_->energy();
}
std::size_t SandBed::memory_bytes() const {
  return impl_->memory_bytes();
}
std::string SandBed::snapshot() const {
  ByteWriter out;
  impl_->save(out);
  return out.take();
}
void SandBed::restore(std::string_view snapshot) {
  ByteReader in(snapshot);
  impl_->restore(in);
}
std::uint64_t SandBed::state_hash() const {
  return impl_->state_hash();
}

BedHealth SandBed::health() const {
  impl_->health.deepest_boundary_ratio =
      std::max(impl_->health.deepest_boundary_ratio, impl_->boundary.take_deepest_ratio());
  return impl_->health;
}

void SandBed::set_contact_pairs(const PairCoefficients& grain_grain,
                                const PairCoefficients& grain_wall) {
  require_pair(grain_grain, "grain_grain");
  require_pair(grain_wall, "grain_wall");
  impl_->settings.grain_grain = grain_grain;
  impl_->settings.grain_wall = grain_wall;
  impl_->set_laws();
}

void SandBed::set_viscous_rate(double rate_1_s) {
  impl_->settings.viscous_rate_1_s = rate_1_s;
  impl_->settings.validate();
}

}  // namespace hoof::sim
