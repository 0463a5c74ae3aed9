#include "sim/dem/sand_bed_impl.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace hoof::sim {
namespace {

double mass_kg(double density_kg_m3, double radius_m) {
  return density_kg_m3 * (4.0 / 3.0 * 3.14159265358979323846) * radius_m * radius_m * radius_m;
}

}  // namespace

template <typename Real>
SandBed::ImplOf<Real>::ImplOf(const DemSettings& s) : Impl(s) {
  set_laws();
  kernel = step_kernel<Real>(s.instruction_set);
}

template <typename Real>
void SandBed::ImplOf<Real>::set_laws() {
  law = cast_pair_law<Real>(
      make_pair_law(settings.grain_material, settings.grain_material, settings.grain_grain));
  boundary.set_law(
      make_pair_law(settings.grain_material, settings.wall_material, settings.grain_wall));
}

template <typename Real>
GrainRecord<Real> SandBed::ImplOf<Real>::to_record(const Grain& g) const {
  if (!(g.radius_m > 0) || !g.p_m.allFinite() || !g.v_m_s.allFinite()) {
    throw std::invalid_argument("bed: grain " + std::to_string(g.id) +
                                " has no positive radius or no finite position and speed");
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double x = g.p_m[axis] - domain.origin_m[axis];
    if (!domain.periodic[axis] && !(x >= 0 && x < domain.length_m(axis))) {
      throw std::invalid_argument("bed: grain " + std::to_string(g.id) +
                                  " lies outside the domain along axis " + "xyz"[axis]);
    }
  }
  Record r{};
  double rest[3];
  r.x = domain.to_steps(0, g.p_m.x(), rest[0]);
  r.y = domain.to_steps(1, g.p_m.y(), rest[1]);
  r.z = domain.to_steps(2, g.p_m.z(), rest[2]);
  r.rx = Real(rest[0]), r.ry = Real(rest[1]), r.rz = Real(rest[2]);
  r.radius_m = Real(g.radius_m);
  r.mass_kg = Real(mass_kg(settings.grain_material.density_kg_m3, g.radius_m));
  r.vx = Real(g.v_m_s.x()), r.vy = Real(g.v_m_s.y()), r.vz = Real(g.v_m_s.z());
  r.wx = Real(g.w_rad_s.x()), r.wy = Real(g.w_rad_s.y()), r.wz = Real(g.w_rad_s.z());
  r.id = g.id;
  return r;
}

template <typename Real>
void SandBed::ImplOf<Real>::load(const BedState& state) {
  if (state.grains.empty()) throw std::invalid_argument("bed: no grains");
  count = std::uint32_t(state.grains.size());
  largest_radius_m = 0;
  now.clear();
  for (const Grain& g : state.grains) {
    now.push_back(to_record(g));
    largest_radius_m = std::max(largest_radius_m, g.radius_m);
  }
  Record padding{};
  padding.mass_kg = 1;
  padding.id = 0xffffffff;
  while (now.size() % kLanes != 0) now.push_back(padding);
  next = now;
  rebuild_lists();
  boundary.prepare<Real>(now.data(), count, domain, interval_time_s);
  store_contacts(state.contacts);
}

template <typename Real>
std::vector<std::uint32_t> SandBed::ImplOf<Real>::rows_by_id() const {
  std::vector<std::uint32_t> rows(count);
  for (std::uint32_t row = 0; row < count; ++row) rows[row] = row;
  std::sort(rows.begin(), rows.end(),
            [&](std::uint32_t a, std::uint32_t b) { return now[a].id < now[b].id; });
  return rows;
}

template <typename Real>
void SandBed::ImplOf<Real>::store_contacts(const std::vector<GrainContact>& contacts) {
  const std::vector<std::uint32_t> rows = rows_by_id();
  const auto row_of = [&](std::uint32_t id) {
    const auto at =
        std::lower_bound(rows.begin(), rows.end(), id,
                         [&](std::uint32_t row, std::uint32_t v) { return now[row].id < v; });
    if (at == rows.end() || now[*at].id != id) {
      throw std::invalid_argument("bed: a contact names grain " + std::to_string(id) +
                                  ", which is not there");
    }
    return *at;
  };
  const auto put = [&](std::uint32_t row, std::uint32_t partner, const Eigen::Vector3d& xi) {
    const std::int64_t s = list.find(row, partner);
    if (s < 0) return;  // no longer near: the history is void
    EllSlot<Real>& slot = list.slots()[std::size_t(s)];
    const std::uint32_t lane = row % kLanes;
    slot.xi_x[lane] = Real(xi.x()), slot.xi_y[lane] = Real(xi.y()), slot.xi_z[lane] = Real(xi.z());
    list.touching()[std::size_t(s)] |= std::uint16_t(1u << lane);
  };
  for (const GrainContact& c : contacts) {
    const std::uint32_t i = row_of(c.i);
    if (c.j >= GrainContact::kWallContact) {
      boundary.set_wall_history(i, int(c.j - GrainContact::kWallContact), c.xi_m);
    } else {
      const std::uint32_t j = row_of(c.j);
      put(i, j, c.xi_m);
      put(j, i, -c.xi_m);
    }
  }
}

template <typename Real>
BedState SandBed::ImplOf<Real>::state() const {
  BedState s;
  for (const std::uint32_t row : rows_by_id()) {
    const Record& r = now[row];
    s.grains.push_back({r.id,
                        double(r.radius_m),
                        domain.position_m(r),
                        {double(r.vx), double(r.vy), double(r.vz)},
                        {double(r.wx), double(r.wy), double(r.wz)}});
    const std::uint32_t group = row / kLanes, lane = row % kLanes;
    const std::size_t first = s.contacts.size();
    for (std::uint32_t k = list.slot_begin()[group]; k < list.slot_begin()[group + 1]; ++k) {
      if (!(list.touching()[k] >> lane & 1)) continue;
      const EllSlot<Real>& slot = list.slots()[k];
      const std::uint32_t partner = now[std::size_t(slot.neighbour[lane])].id;
      if (partner > r.id) {
        s.contacts.push_back(
            {r.id,
             partner,
             {double(slot.xi_x[lane]), double(slot.xi_y[lane]), double(slot.xi_z[lane])}});
      }
    }
    for (int w = 0; w < int(settings.walls.size()); ++w) {
      Eigen::Vector3d xi;
      if (boundary.wall_history(row, w, xi)) {
        s.contacts.push_back({r.id, GrainContact::kWallContact + std::uint32_t(w), xi});
      }
    }
    std::sort(s.contacts.begin() + std::ptrdiff_t(first), s.contacts.end(),
              [](const GrainContact& a, const GrainContact& b) { return a.j < b.j; });
  }
  return s;
}

template <typename Real>
StepArguments<Real> SandBed::ImplOf<Real>::arguments() {
  StepArguments<Real> a{};
  a.in = now.data();
  a.out = next.data();
  a.slots = list.slots().data();
  a.touching = list.touching().data();
  a.slot_begin = list.slot_begin().data();
  a.boundary = boundary.forces<Real>().data();
  a.boundary_of_group = boundary.force_of_group().data();
  a.lsb_x_m = Real(domain.lsb_m.x()), a.lsb_y_m = Real(domain.lsb_m.y());
  a.lsb_z_m = Real(domain.lsb_m.z());
  a.dt_s = Real(settings.dt_s);
  a.gx = Real(settings.gravity_m_s2.x()), a.gy = Real(settings.gravity_m_s2.y());
  a.gz = Real(settings.gravity_m_s2.z());
  a.velocity_factor = Real(1 - settings.viscous_rate_1_s * settings.dt_s);
  a.law = law;
  a.cap = settings.coulomb_cap;
  a.rolling = settings.rolling_law;
  return a;
}

template <typename Real>
double SandBed::ImplOf<Real>::largest_displacement_m() {
  double largest2 = 0;
  for (std::uint32_t row = 0; row < count; ++row) {
    const auto moved = [](std::int32_t a, std::int32_t b) {
      return double(std::int32_t(std::uint32_t(a) - std::uint32_t(b)));
    };
    const double dx = domain.lsb_m.x() * moved(now[row].x, listed_at[row][0]);
    const double dy = domain.lsb_m.y() * moved(now[row].y, listed_at[row][1]);
    const double dz = domain.lsb_m.z() * moved(now[row].z, listed_at[row][2]);
    largest2 = std::max(largest2, dx * dx + dy * dy + dz * dz);
  }
  return std::sqrt(largest2);
}

template <typename Real>
void SandBed::ImplOf<Real>::rebuild_lists() {
  const std::vector<std::uint32_t>& old_row =
      list.rebuild(now, count, domain, largest_radius_m, settings.skin_m, team);
  boundary.reorder(old_row);
  listed_at.resize(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    listed_at[row] = {now[row].x, now[row].y, now[row].z};
  }
  // Members get groups of about equal numbers of list places.
  const std::uint32_t groups = list.group_count();
  part.assign(std::size_t(team.size()) + 1, groups);
  const std::uint64_t total = list.slot_begin()[groups] + std::uint64_t(groups);
  std::uint32_t group = 0;
  for (int member = 0; member < team.size(); ++member) {
    while (group < groups &&
           (list.slot_begin()[group] + std::uint64_t(group)) * std::uint64_t(team.size()) <
               total * std::uint64_t(member)) {
      ++group;
    }
    part[std::size_t(member)] = group;
  }
  grain_travel_m = 0;
  ++health.rebuilds;
}

/// Lists are good while no pair can have closed the skin. The fastest grain bounds the travel; only
/// when that bound is used up are the displacements themselves looked at, so a single rattling
/// grain does not set the pace.
template <typename Real>
void SandBed::ImplOf<Real>::rebuild_if_stale() {
  const double margin_m = 0.5 * settings.skin_m;
  if (grain_travel_m > margin_m) {
    grain_travel_m = largest_displacement_m();
    if (grain_travel_m > 0.75 * margin_m) rebuild_lists();
  }
}

template <typename Real>
void SandBed::ImplOf<Real>::check(double fastest_m_s) {
  health.fastest_m_s = fastest_m_s;
  ++health.steps;
  health.time_s = double(health.steps) * settings.dt_s;
  // A grain that crosses a tenth of the largest grain's radius in one step is no longer resolved;
  // sand under a foot moves at metres per second at most.
  const double limit_m_s = 0.1 * largest_radius_m / settings.dt_s;
  if (!(fastest_m_s < limit_m_s)) {
    throw std::runtime_error(
        "bed: blow-up at step " + std::to_string(health.steps) + ": a grain moves at " +
        std::to_string(fastest_m_s) + " m/s (bound " + std::to_string(limit_m_s) +
        " m/s); a smaller bed.dt_s may help (now " + std::to_string(settings.dt_s * 1e6) + " us)");
  }
}

template <typename Real>
void SandBed::ImplOf<Real>::step() {
  rebuild_if_stale();
  boundary.prepare<Real>(now.data(), count, domain, interval_time_s);
  const StepArguments<Real> a = arguments();
  std::vector<Real> fastest2(std::size_t(team.size()), Real(0));
  team.run([&](int member) {
    const std::uint32_t begin = part[std::size_t(member)], end = part[std::size_t(member) + 1];
    boundary.compute<Real>(a.in, domain, settings.dt_s, begin, end);
    fastest2[std::size_t(member)] = kernel(a, begin, end);
  });
  now.swap(next);
  double largest2 = 0;
  for (const Real v2 : fastest2) {
    if (!(double(v2) <= largest2)) largest2 = double(v2);  // a NaN gets through to the check
  }
  const double fastest = std::sqrt(largest2);
  check(fastest);
  grain_travel_m += fastest * settings.dt_s;
  boundary.advance(fastest * settings.dt_s);
  interval_time_s += settings.dt_s;
}

template <typename Real>
double SandBed::ImplOf<Real>::coordination_number() const {
  std::uint64_t touches = 0;
  for (const std::uint16_t bits : list.touching())
    touches += std::uint64_t(__builtin_popcount(bits));
  return double(touches) / double(count);
}

template <typename Real>
double SandBed::ImplOf<Real>::kinetic_energy_J() const {
  double sum = 0;
  for (std::uint32_t row = 0; row < count; ++row) {
    const Record& r = now[row];
    const double v2 = double(r.vx) * r.vx + double(r.vy) * r.vy + double(r.vz) * r.vz;
    const double w2 = double(r.wx) * r.wx + double(r.wy) * r.wy + double(r.wz) * r.wz;
    sum += 0.5 * r.mass_kg * (v2 + 0.4 * double(r.radius_m) * r.radius_m * w2);
  }
  return sum;
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
    const Record& r = now[row];
    const Real words[] = {r.radius_m, r.vx, r.vy, r.vz, r.wx, r.wy, r.wz, r.rx, r.ry, r.rz};
    const std::int32_t steps[] = {r.x, r.y, r.z, std::int32_t(r.id)};
    unsigned char bytes[sizeof words + sizeof steps];
    std::memcpy(bytes, words, sizeof words);
    std::memcpy(bytes + sizeof words, steps, sizeof steps);
    for (const unsigned char b : bytes) hash = (hash ^ b) * 0x100000001b3u;
  }
  return hash;
}

template struct SandBed::ImplOf<float>;
template struct SandBed::ImplOf<double>;

}  // namespace hoof::sim
