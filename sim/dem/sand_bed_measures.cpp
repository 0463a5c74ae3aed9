// What can be read off a bed: energies, momentum, health.
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "sim/dem/sand_bed_impl.h"

namespace hoof::sim {

/// Where and what a grain is, for errors.
template <typename Real>
std::string SandBed::ImplOf<Real>::grain_text(std::uint32_t row) const {
  const Eigen::Vector3d p_mm = 1e3 * domain.position_m(now[row]);
  return "grain " + std::to_string(now[row].id) + " of " +
         std::to_string(2e3 * double(now[row].radius_m)) + " mm at (" + std::to_string(p_mm.x()) +
         ", " + std::to_string(p_mm.y()) + ", " + std::to_string(p_mm.z()) + ") mm";
}

template <typename Real>
void SandBed::ImplOf<Real>::check_speed(double fastest_m_s) {
  health.fastest_m_s = fastest_m_s;
  ++health.steps;
  health.time_s = double(health.steps) * settings.dt_s;
  // A grain that crosses a tenth of the largest grain's radius in one step is no longer resolved;
  // sand under a foot moves at metres per second at most.
  const double limit_m_s = 0.1 * largest_radius_m / settings.dt_s;
  if (fastest_m_s < limit_m_s) return;
  std::uint32_t worst = 0;
  double worst_m_s = -1;
  for (std::uint32_t row = 0; row < count; ++row) {
    const double v = Eigen::Vector3d(now[row].vx, now[row].vy, now[row].vz).norm();
    if (!(v <= worst_m_s)) worst = row, worst_m_s = v;
    if (std::isnan(v)) break;
  }
  throw std::runtime_error(
      "bed: blow-up at step " + std::to_string(health.steps) + ": " + grain_text(worst) +
      " moves at " + std::to_string(worst_m_s) + " m/s (bound " + std::to_string(limit_m_s) +
      " m/s, a tenth of the largest radius a step); a smaller time step may help: raise " +
      "bed.steps_per_ms (step now " + std::to_string(settings.dt_s * 1e6) + " us)");
}

/// At an audit: how deep grains lie in each other and how near the step is to the bound of
/// stability.
template <typename Real>
void SandBed::ImplOf<Real>::check_load(const WindowResult& worst) {
  health.deepest_ratio = worst.deepest_ratio;
  health.step_ratio = settings.dt_s * std::sqrt(worst.stiffest_1_s2) / 2;
  if (!(worst.deepest_ratio < 1)) {
    throw std::runtime_error(
        "bed: blow-up at step " + std::to_string(health.steps) + ": two grains overlap by " +
        std::to_string(worst.deepest_ratio) +
        " of the smaller one's radius (bound 1: its centre); a smaller load, a stiffer grain " +
        "(materials.sand.young_MPa) or a smaller time step may help: raise bed.steps_per_ms");
  }
  if (!(health.step_ratio < 1)) {
    throw std::runtime_error(
        "bed: unstable at step " + std::to_string(health.steps) + ": the step of " +
        std::to_string(settings.dt_s * 1e6) + " us is " + std::to_string(health.step_ratio) +
        " of the bound 2 sqrt(m/k) of the stiffest held grain (bound 1); raise bed.steps_per_ms");
  }
}

/// At an audit: no grain may be behind a wall or about to leave the domain, where it would come in
/// again on the other side.
template <typename Real>
void SandBed::ImplOf<Real>::check_places() {
  const double until_next_s = settings.audit_steps * settings.dt_s;
  for (std::uint32_t row = 0; row < count; ++row) {
    const Eigen::Vector3d p_m = domain.position_m(now[row]);
    const Eigen::Vector3d v_m_s(now[row].vx, now[row].vy, now[row].vz);
    bool lost = false;
    for (const Wall& w : settings.walls) {
      lost |= w.normal.dot(p_m) - w.offset_m < -double(now[row].radius_m);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double x_m = p_m[axis] - domain.origin_m[axis] + v_m_s[axis] * until_next_s;
      lost |= !domain.periodic[std::size_t(axis)] && !(x_m > 0 && x_m < domain.length_m(axis));
    }
    if (!lost) continue;
    throw std::runtime_error("bed: lost at step " + std::to_string(health.steps) + ": " +
                             grain_text(row) +
                             " is behind a wall or at the edge of the domain; a smaller time step "
                             "may help: raise bed.steps_per_ms");
  }
}

template <typename Real>
double SandBed::ImplOf<Real>::coordination_number() const {
  std::uint64_t touches = 0;
  for (std::uint32_t g = 0; g < list.group_count(); ++g) {
    const std::uint32_t begin = list.slot_begin()[g];
    for (std::uint32_t s = begin; s < begin + list.slot_count()[g]; ++s) {
      touches += std::uint64_t(__builtin_popcount(list.touching()[s]));
    }
  }
  return double(touches) / double(count);
}

template <typename Real>
double SandBed::ImplOf<Real>::kinetic_energy_J(const Records& records) const {
  double sum = 0;
  for (std::uint32_t row = 0; row < count; ++row) {
    const Record& r = records[row];
    const double v2 = double(r.vx) * r.vx + double(r.vy) * r.vy + double(r.vz) * r.vz;
    const double w2 = double(r.wx) * r.wx + double(r.wy) * r.wy + double(r.wz) * r.wz;
    sum += 0.5 * r.mass_kg * (v2 + 0.4 * double(r.radius_m) * r.radius_m * w2);
  }
  return sum;
}

template <typename Real>
double SandBed::ImplOf<Real>::kinetic_energy_J() const {
  return kinetic_energy_J(now);
}

/// All at the time of the last step's forces: positions before the step, velocities as the mean of
/// half a step before and after.
template <typename Real>
EnergyBalance SandBed::ImplOf<Real>::energy() const {
  if (!settings.account_energy || health.steps == 0) {
    throw std::logic_error("energy() needs account_energy and a step");
  }
  EnergyBalance e = lost;
  e.boundary = boundary.energy();
  // The brake on a grain's own spin is one for all its contacts and booked with the grains.
  if (settings.rolling_law == RollingLaw::kOwnSpin) e.boundary.lost_rolling_J = 0;
  e.work_by_meshes_J -= boundary.pending_work_J();
  e.kinetic_J = 0.5 * (kinetic_energy_J(next) + kinetic_energy_J(now));
  for (std::uint32_t row = 0; row < count; ++row) {
    const Eigen::Vector3d p_m = domain.position_m(next[row]) - domain.origin_m;
    e.potential_J -= double(next[row].mass_kg) * settings.gravity_m_s2.dot(p_m);
  }
  return e;
}

template <typename Real>
Eigen::Vector3d SandBed::ImplOf<Real>::momentum_kg_m_s() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::uint32_t row = 0; row < count; ++row) {
    sum += double(now[row].mass_kg) *
           Eigen::Vector3d(double(now[row].vx), double(now[row].vy), double(now[row].vz));
  }
  return sum;
}

template <typename Real>
std::uint64_t SandBed::ImplOf<Real>::state_hash() const {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint32_t row : rows_by_id()) {
    unsigned char bytes[sizeof(Record)];
    std::memcpy(bytes, &now[row], sizeof bytes);
    for (const unsigned char b : bytes) hash = (hash ^ b) * 0x100000001b3u;
  }
  return hash;
}

template <typename Real>
std::size_t SandBed::ImplOf<Real>::memory_bytes() const {
  return (now.capacity() + next.capacity()) * sizeof(Record) + list.bytes() +
         results.capacity() * sizeof(WindowResult);
}

#define HOOF_INSTANTIATE(Real)                                             \
  template void SandBed::ImplOf<Real>::check_speed(double);                \
  template void SandBed::ImplOf<Real>::check_load(const WindowResult&);    \
  template void SandBed::ImplOf<Real>::check_places();                     \
  template double SandBed::ImplOf<Real>::coordination_number() const;      \
  template double SandBed::ImplOf<Real>::kinetic_energy_J() const;         \
  template EnergyBalance SandBed::ImplOf<Real>::energy() const;            \
  template Eigen::Vector3d SandBed::ImplOf<Real>::momentum_kg_m_s() const; \
  template std::uint64_t SandBed::ImplOf<Real>::state_hash() const;        \
  template std::size_t SandBed::ImplOf<Real>::memory_bytes() const;
HOOF_INSTANTIATE(float)
HOOF_INSTANTIATE(double)
#undef HOOF_INSTANTIATE

}  // namespace hoof::sim
