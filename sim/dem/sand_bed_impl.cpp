#include "sim/dem/sand_bed_impl.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/dem/flush_to_zero.h"

namespace hoof::sim {
namespace {

double mass_per_r3(double density_kg_m3) {
  return density_kg_m3 * (4.0 / 3.0 * 3.14159265358979323846);
}

constexpr std::uint32_t kWindowsAtOnce = 8;  // of a member's share, taken in one go
// The automatic skin, in smallest radii. Below, lists hardly get shorter; above, they grow faster
// than looking up gets rarer.
constexpr double kFirstSkin = 0.06, kThinnestSkin = 0.03, kWidestSkin = 1;
constexpr double kBoundarySkin = 0.2;  // likewise: few grains, so long lists cost little
constexpr int kSkinSteps = 128;        // how often it is thought over

}  // namespace

template <typename Real>
SandBed::ImplOf<Real>::ImplOf(const DemSettings& s)
    : Impl(s), cursors(std::make_unique<Cursor[]>(std::size_t(s.threads))) {
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
  r.x = domain.to_steps<Real>(0, g.p_m.x(), rest[0]);
  r.y = domain.to_steps<Real>(1, g.p_m.y(), rest[1]);
  r.z = domain.to_steps<Real>(2, g.p_m.z(), rest[2]);
  if constexpr (sizeof(Real) == 4) {
    r.rx = Real(rest[0]), r.ry = Real(rest[1]), r.rz = Real(rest[2]);
  }
  r.radius_m = Real(g.radius_m);
  r.mass_kg = Real(mass_per_r3(settings.grain_material.density_kg_m3) * g.radius_m * g.radius_m *
                   g.radius_m);
  r.vx = Real(g.v_m_s.x()), r.vy = Real(g.v_m_s.y()), r.vz = Real(g.v_m_s.z());
  r.wx = Real(g.w_rad_s.x()), r.wy = Real(g.w_rad_s.y()), r.wz = Real(g.w_rad_s.z());
  r.id = g.id;
  return r;
}

template <typename Real>
GrainRecord<Real> SandBed::ImplOf<Real>::padding() const {
  Record r{};
  r.mass_kg = 1;
  r.id = 0xffffffff;
  return r;
}

template <typename Real>
void SandBed::ImplOf<Real>::load(const BedState& state) {
  if (state.grains.empty()) throw std::invalid_argument("bed: no grains");
  count = std::uint32_t(state.grains.size());
  largest_radius_m = 0;
  smallest_radius_m = state.grains.front().radius_m;
  now.clear();
  for (const Grain& g : state.grains) {
    now.push_back(to_record(g));
    largest_radius_m = std::max(largest_radius_m, g.radius_m);
    smallest_radius_m = std::min(smallest_radius_m, g.radius_m);
  }
  now.resize((now.size() + kLanes - 1) / kLanes * kLanes, padding());
  next = now;
  boundary.set_skin(settings.skin_m > 0 ? settings.skin_m : kBoundarySkin * smallest_radius_m);
  sort_lists(settings.skin_m > 0 ? settings.skin_m : kFirstSkin * smallest_radius_m);
  boundary.prepare<Real>(now.data(), count, domain, interval_time_s);
  store_contacts(state.contacts);
}

template <typename Real>
std::vector<std::uint32_t> SandBed::ImplOf<Real>::rows_by_id(
    const Eigen::AlignedBox3d* region_m) const {
  std::vector<std::uint32_t> rows;
  rows.reserve(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    if (region_m == nullptr || region_m->contains(domain.position_m(now[row]))) rows.push_back(row);
  }
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
    EllSlot<Real>& slot = list.slots()[s];
    const std::uint32_t lane = row % kLanes;
    slot.xi_x[lane] = Real(xi.x()), slot.xi_y[lane] = Real(xi.y()), slot.xi_z[lane] = Real(xi.z());
    list.touching()[s] |= std::uint16_t(1u << lane);
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
BedState SandBed::ImplOf<Real>::state(const Eigen::AlignedBox3d* region_m) const {
  BedState s;
  const std::vector<std::uint32_t> rows = rows_by_id(region_m);
  s.grains.reserve(rows.size());
  for (const std::uint32_t row : rows) {
    const Record& r = now[row];
    s.grains.push_back({r.id,
                        double(r.radius_m),
                        domain.position_m(r),
                        {double(r.vx), double(r.vy), double(r.vz)},
                        {double(r.wx), double(r.wy), double(r.wz)}});
    const std::uint32_t group = row / kLanes, lane = row % kLanes;
    const std::size_t first = s.contacts.size();
    const std::uint32_t begin = list.slot_begin()[group];
    for (std::uint32_t k = begin; k < begin + list.slot_count()[group]; ++k) {
      if (!(list.touching()[k] >> lane & 1)) continue;
      const EllSlot<Real>& slot = list.slots()[k];
      const Record& other = now[std::size_t(slot.neighbour[lane])];
      const bool is_in = region_m == nullptr || region_m->contains(domain.position_m(other));
      if (other.id > r.id && is_in) {
        s.contacts.push_back(
            {r.id,
             other.id,
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
std::vector<MeshTouch> SandBed::ImplOf<Real>::mesh_touches() const {
  return boundary.mesh_touches<Real>(now.data(), domain, interval_time_s);
}

template <typename Real>
StepArguments<Real> SandBed::ImplOf<Real>::arguments(bool account) {
  StepArguments<Real> a{};
  a.in = now.data();
  a.out = next.data();
  a.slots = list.slots();
  a.touching = list.touching();
  a.slot_begin = list.slot_begin().data();
  a.slot_count = list.slot_count().data();
  a.boundary = boundary.forces<Real>().data();
  a.boundary_of_group = boundary.force_of_group().data();
  a.results = results.data();
  a.group_count = list.group_count();
  a.lsb_x_m = Real(domain.lsb_m<Real>(0)), a.lsb_y_m = Real(domain.lsb_m<Real>(1));
  a.lsb_z_m = Real(domain.lsb_m<Real>(2));
  a.dt_s = Real(settings.dt_s);
  a.gx = Real(settings.gravity_m_s2.x()), a.gy = Real(settings.gravity_m_s2.y());
  a.gz = Real(settings.gravity_m_s2.z());
  a.velocity_factor = Real(1 - settings.viscous_rate_1_s * settings.dt_s);
  a.mass_per_r3 = Real(mass_per_r3(settings.grain_material.density_kg_m3));
  a.law = law;
  a.cap = settings.coulomb_cap;
  a.rolling = settings.rolling_law;
  a.account = account;
  return a;
}

template <typename Real>
void SandBed::ImplOf<Real>::sort_lists(double skin_m) {
  const double cell_m = settings.cell_m > 0 ? settings.cell_m : 1.6 * largest_radius_m;
  boundary.reorder(list.sort(now, next, count, domain, {largest_radius_m, skin_m, cell_m}, team));
  share_out();
  ++health.rebuilds;
}

template <typename Real>
void SandBed::ImplOf<Real>::share_out() {
  // Members get windows of about equal numbers of list places; who is done first takes from others.
  results.assign(list.window_count(), {});
  share.assign(std::size_t(team.size()) + 1, list.window_count());
  std::uint64_t total = 0, passed = 0;
  for (const std::uint32_t n : list.slot_count()) total += n + 1;
  int member = 0;
  for (std::uint32_t w = 0; w < list.window_count(); ++w) {
    while (member < team.size() &&
           passed * std::uint64_t(team.size()) >= total * std::uint64_t(member)) {
      share[std::size_t(member++)] = w;
    }
    const std::uint32_t first = w * kGroupsPerWindow;
    for (std::uint32_t g = first; g < std::min(first + kGroupsPerWindow, list.group_count()); ++g) {
      passed += list.slot_count()[g] + 1;
    }
  }
}

/// Looking neighbours up costs some 700 ns a grain, long lists 15 ns a step and grain for a skin as
/// wide as the smallest radius (both measured); the skin at which both cost the same is best. It is
/// changed by factors of two, and not for less than a factor of two in cost.
template <typename Real>
double SandBed::ImplOf<Real>::fitting_skin_m() {
  const double skin_m = list.reach().skin_m;
  if (settings.skin_m > 0 || health.steps % kSkinSteps != 0 || health.steps == 0) return skin_m;
  const double looked_up_ns =
      700.0 * double(list.take_renewed()) / (double(count) * double(kSkinSteps));
  const double listed_ns = 15 * skin_m / smallest_radius_m;
  if (looked_up_ns > 2 * listed_ns && skin_m < 0.75 * kWidestSkin * smallest_radius_m) {
    return 2 * skin_m;
  }
  if (looked_up_ns < 0.125 * listed_ns && skin_m > 1.5 * kThinnestSkin * smallest_radius_m) {
    return 0.5 * skin_m;
  }
  return skin_m;
}

template <typename Real>
void SandBed::ImplOf<Real>::refresh_lists() {
  const double skin_m = fitting_skin_m();
  if (skin_m != list.reach().skin_m || list.is_scattered()) {
    sort_lists(skin_m);
  } else {
    health.renewed += list.update(now, team);
  }
}

/// Calls work(begin, end) for all of this member's windows, then for what others have left.
template <typename Real>
void SandBed::ImplOf<Real>::share_windows(
    int member, const std::function<void(std::uint32_t, std::uint32_t)>& work) {
  for (int i = 0; i < team.size(); ++i) {
    const auto whose = std::size_t((member + i) % team.size());
    const std::uint32_t end = share[whose + 1];
    for (;;) {
      const std::uint32_t begin =
          cursors[whose].next.fetch_add(kWindowsAtOnce, std::memory_order_relaxed);
      if (begin >= end) break;
      work(begin, std::min(begin + kWindowsAtOnce, end));
    }
  }
}

template <typename Real>
void SandBed::ImplOf<Real>::compute_forces(const StepArguments<Real>& a) {
  for (int m = 0; m < team.size(); ++m) {
    cursors[std::size_t(m)].next.store(share[std::size_t(m)], std::memory_order_relaxed);
  }
  team.run([&](int member) {
    const FlushToZero flush;
    share_windows(member, [&](std::uint32_t begin, std::uint32_t end) {
      boundary.compute<Real>(a.in, domain, settings.dt_s, begin * kGroupsPerWindow,
                             std::min(end * kGroupsPerWindow, a.group_count));
      kernel(a, begin, end);
    });
  });
}

template <typename Real>
bool SandBed::ImplOf<Real>::is_audit_due() const {
  return settings.audit_steps > 0 && health.steps % std::uint64_t(settings.audit_steps) == 0;
}

template <typename Real>
void SandBed::ImplOf<Real>::step() {
  refresh_lists();
  boundary.prepare<Real>(now.data(), count, domain, interval_time_s);
  const bool audit = is_audit_due();
  compute_forces(arguments(settings.account_energy || audit));
  now.swap(next);
  take_results();
  if (audit) check_places();
  interval_time_s += settings.dt_s;
}

template <typename Real>
void SandBed::ImplOf<Real>::take_results() {
  double fastest_m_s = 0;
  for (const WindowResult& r : results) {
    if (!(r.fastest_m_s <= fastest_m_s)) fastest_m_s = r.fastest_m_s;  // a NaN gets through
    if (std::isnan(fastest_m_s)) break;
  }
  check_speed(fastest_m_s);
  list.travelled([&](std::size_t w) { return results[w].fastest_m_s * settings.dt_s; });
  boundary.advance(fastest_m_s * settings.dt_s);
  WindowResult sum;
  for (const WindowResult& r : results) {
    sum.contacts += r.contacts;
    sum.viscous_loss_J += r.viscous_loss_J;
    sum.deepest_ratio = std::max(sum.deepest_ratio, r.deepest_ratio);
    sum.stiffest_1_s2 = std::max(sum.stiffest_1_s2, r.stiffest_1_s2);
  }
  if (sum.stiffest_1_s2 > 0) check_load(sum);  // zero: not asked for in this step
  if (!settings.account_energy) return;
  lost.grain_grain += sum.contacts;
  lost.grain_grain.stored_normal_J = sum.contacts.stored_normal_J;
  lost.grain_grain.stored_tangential_J = sum.contacts.stored_tangential_J;
  lost.viscous_loss_J += sum.viscous_loss_J;
}

template struct SandBed::ImplOf<float>;
template struct SandBed::ImplOf<double>;

}  // namespace hoof::sim
