// The step in lanes. Included once per instruction set with HOOF_ISA (a namespace) and
// HOOF_VECTOR_BYTES set; see lanes.h for what it may include.
//
// A group has 16 rows on every instruction set; a narrower one takes them in 2 to 8 parts. Rows do
// not talk to each other, so the parts change no bit.
//
// A part goes over its neighbours twice: first distances and roots of all, then forces of those
// that touch. Each pass has short dependencies, so that the processor works on several neighbours
// at once while the slow roots are under way; in one pass it waited for them most of the time.
#pragma once

#include "sim/dem/lanes.h"
#include "sim/dem/step_kernel.h"

namespace hoof::sim {
namespace HOOF_ISA {

/// kCount grains, one a lane.
template <typename Real>
struct Gathered {
  using V = typename Lanes<Real>::V;
  using I = typename Lanes<Real>::I;
  I x{}, y{}, z{};
  V radius{}, mass{};
  V rx{}, ry{}, rz{};  // float only
  Vec3<V> v{}, w{};
  V id{};  // its bits
};

/// Addresses of quad q of the records that row_of names.
template <typename Record, typename RowOf>
HOOF_INLINE auto quad_of(Record* records, const RowOf& row_of, int quad) {
  using Word = decltype(records->radius_m);
  return [=](int lane) HOOF_INLINE_LAMBDA {
    if constexpr (__is_same(Record, const GrainRecord<Word>)) {
      return reinterpret_cast<const Word*>(records + row_of(lane)) + 4 * quad;
    } else {
      return reinterpret_cast<Word*>(records + row_of(lane)) + 4 * quad;
    }
  };
}

// In mixed precision the part below one step (0.1 nm in the paper's box) is left out of distances:
// it is some 4e-5 of the overlap under a grain's own weight, below single precision's own error.
template <typename Real, typename RowOf>
HOOF_INLINE void gather_position(const GrainRecord<Real>* r, const RowOf& row_of,
                                 Gathered<Real>& g) {
  typename Lanes<Real>::V x, y, z;
  load_quad(quad_of(r, row_of, 0), x, y, z, g.radius);
  using I = typename Lanes<Real>::I;
  g.x = (I)x, g.y = (I)y, g.z = (I)z;
}
template <typename Real, typename RowOf>
HOOF_INLINE void gather_motion(const GrainRecord<Real>* r, const RowOf& row_of, Gathered<Real>& g) {
  load_quad(quad_of(r, row_of, 1), g.v.x, g.v.y, g.v.z, g.mass);
  load_quad(quad_of(r, row_of, 2), g.w.x, g.w.y, g.w.z, g.id);
}
template <typename Real, typename RowOf>
HOOF_INLINE void gather_rest(const GrainRecord<Real>* r, const RowOf& row_of, Gathered<Real>& g) {
  typename Lanes<Real>::V unused;
  if constexpr (sizeof(Real) == 4) load_quad(quad_of(r, row_of, 3), g.rx, g.ry, g.rz, unused);
}
template <typename Real, typename RowOf>
HOOF_INLINE void store_rows(const Gathered<Real>& g, GrainRecord<Real>* out, const RowOf& row_of) {
  using V = typename Lanes<Real>::V;
  store_quad(quad_of(out, row_of, 0), (V)g.x, (V)g.y, (V)g.z, g.radius);
  store_quad(quad_of(out, row_of, 1), g.v.x, g.v.y, g.v.z, g.mass);
  store_quad(quad_of(out, row_of, 2), g.w.x, g.w.y, g.w.z, g.id);
  if constexpr (sizeof(Real) == 4) store_quad(quad_of(out, row_of, 3), g.rx, g.ry, g.rz, V{});
}

/// Difference of two fixed-point coordinates in metres. Wraps, so it is right across a periodic
/// side.
template <typename Real>
HOOF_INLINE typename Lanes<Real>::V difference_m(typename Lanes<Real>::I a,
                                                 typename Lanes<Real>::I b, Real lsb_m) {
  using I = typename Lanes<Real>::I;
  using U = typename Lanes<Real>::U;
  const I steps = (I)((U)a - (U)b);
  return lsb_m * __builtin_convertvector(steps, typename Lanes<Real>::V);
}

/// Moves a coordinate by `steps` (of the lsb, any real number); the part below one step is kept in
/// single precision, where it matters.
template <typename Real>
HOOF_INLINE void drift(typename Lanes<Real>::I& x, typename Lanes<Real>::V& rest,
                       typename Lanes<Real>::V steps) {
  using V = typename Lanes<Real>::V;
  using I = typename Lanes<Real>::I;
  using U = typename Lanes<Real>::U;
  const V sum = steps + rest;
  // Truncation is enough: the rest then lies in (-1, 1) and nothing is lost.
  const I whole = __builtin_convertvector(sum, I);
  if constexpr (sizeof(Real) == 4) rest = sum - __builtin_convertvector(whole, V);
  x = (I)((U)x + (U)whole);
}

/// Sums of one part of a group.
template <typename Real>
struct Row {
  using V = typename Lanes<Real>::V;
  Gathered<Real> g;
  V r3{};            // radius cubed
  Vec3<V> f{}, t{};  // force N, torque Nm
  V rolling{};       // kOwnSpin: sum of mu_r F_n; the torque is this times the radius
  // For the account; see WindowResult.
  V stored_n{}, stored_t{}, lost_n{}, lost_t{}, lost_rolling{}, lost_viscous{}, deepest{},
      stiffness{};
};

/// What the first pass finds out about one place of the list.
template <typename Real>
struct Near {
  using V = typename Lanes<Real>::V;
  V d2;       // squared distance, m^2; zero where the lane does not touch
  V delta;    // overlap, m; likewise
  V radius;   // of the partner, m
  V a, root;  // contact radius, m; sqrt(a m_eff)
  Vec3<V> n;
  std::uint32_t slot;
};

/// Geometry of the k-th neighbours of the lanes.
/// @return false if none touches now, nor did in the last step
template <typename Real>
HOOF_INLINE bool look_at(const StepArguments<Real>& a, std::uint32_t slot, int first_lane,
                         const Row<Real>& row, Near<Real>& near) {
  using V = typename Lanes<Real>::V;
  constexpr std::uint32_t kAll = (1u << Lanes<Real>::kCount) - 1u;
  const std::int32_t* neighbour = a.slots[slot].neighbour + first_lane;
  Gathered<Real> other;
  gather_position(
      a.in, [&](int lane) HOOF_INLINE_LAMBDA { return neighbour[lane]; }, other);
  const Gathered<Real>& self = row.g;
  const Vec3<V> d = {difference_m<Real>(self.x, other.x, a.lsb_x_m),
                     difference_m<Real>(self.y, other.y, a.lsb_y_m),
                     difference_m<Real>(self.z, other.z, a.lsb_z_m)};
  const V reach = self.radius + other.radius;
  const V d2 = dot(d, d);
  // An empty place names the row itself, at distance exactly zero; two grains never are.
  const auto close = (d2 < reach * reach) & (d2 > V{});
  const std::uint32_t before = (std::uint32_t(a.touching[slot]) >> first_lane) & kAll;
  if ((mask_bits(close) | before) == 0) return false;

  near.d2 = lane_select(close, d2, V{});
  near.n = d;
  near.radius = other.radius;
  near.slot = slot;
  return true;
}

/// The slow roots of a place that touches. A pass of its own: many are then under way at once.
template <typename Real>
HOOF_INLINE void take_roots(const StepArguments<Real>& a, const Row<Real>& row, Near<Real>& near) {
  using V = typename Lanes<Real>::V;
  const V one = V{} + Real(1);
  const auto close = near.d2 > V{};
  const V reach = row.g.radius + near.radius;
  const V dist = lane_sqrt(lane_select(close, near.d2, one));
  near.delta = lane_select(close, reach - dist, V{});
  // One division for all: 1/dist, R* = r_i r_j / (r_i + r_j), and m* likewise from the cubes, all
  // grains being of one density.
  const V r3 = near.radius * near.radius * near.radius;
  const V sum3 = row.r3 + r3;
  const V dist_reach = dist * reach;
  const V per_all = one / lane_select(close, dist_reach * sum3, one);
  near.n = (per_all * (reach * sum3)) * near.n;
  const V R_eff = row.g.radius * near.radius * (per_all * (dist * sum3));
  const V m_eff = a.mass_per_r3 * (row.r3 * r3) * (per_all * dist_reach);
  near.a = lane_sqrt(R_eff * near.delta);
  near.root = lane_sqrt(near.a * m_eff);
}

/// Force of the k-th neighbours on the lanes. Nothing is left where a lane does not touch: its
/// overlap is zero, and with it the contact radius and all that follows from it.
template <typename Real, bool kAccount>
HOOF_INLINE void add_force(const StepArguments<Real>& a, const Near<Real>& near, int first_lane,
                           Row<Real>& row) {
  using V = typename Lanes<Real>::V;
  constexpr std::uint32_t kAll = (1u << Lanes<Real>::kCount) - 1u;
  EllSlot<Real>& slot = a.slots[near.slot];
  std::uint16_t& touching = a.touching[near.slot];
  const auto touches = near.delta > V{};
  touching = std::uint16_t((touching & ~(kAll << first_lane)) | (mask_bits(touches) << first_lane));

  const std::int32_t* neighbour = slot.neighbour + first_lane;
  Gathered<Real> other;
  gather_motion(
      a.in, [&](int lane) HOOF_INLINE_LAMBDA { return neighbour[lane]; }, other);
  const Gathered<Real>& self = row.g;
  Vec3<V> xi = {load<V>(slot.xi_x + first_lane), load<V>(slot.xi_y + first_lane),
                load<V>(slot.xi_z + first_lane)};
  const V c_i = self.radius - Real(0.5) * near.delta;
  const V c_j = near.radius - Real(0.5) * near.delta;
  const Touch<V> c = {near.delta, near.n, self.v - other.v, c_i * self.w + c_j * other.w};
  const TouchForce<V> force = touch_force<V, Real>(a.law, a.cap, a.dt_s, c, near.a, near.root, xi);

  xi.x = lane_select(touches, xi.x, V{});
  xi.y = lane_select(touches, xi.y, V{});
  xi.z = lane_select(touches, xi.z, V{});
  store(slot.xi_x + first_lane, xi.x);
  store(slot.xi_y + first_lane, xi.y);
  store(slot.xi_z + first_lane, xi.z);
  row.f = row.f + (force.f_normal + force.f_tangential);
  row.t = row.t + c_i * cross(force.f_tangential, near.n);  // (-c_i n) x f_t
  const V rolling = a.law.mu_r * force.F_n_elastic;
  if (a.rolling == RollingLaw::kOwnSpin) {
    row.rolling += rolling;
  } else {
    const Vec3<V> w_rel = self.w - other.w;
    const V w2 = dot(w_rel, w_rel);
    const V one = V{} + Real(1);
    const V w_abs = lane_sqrt(lane_select(w2 > V{}, w2, one));
    const V R_eff = self.radius * near.radius / (self.radius + near.radius);
    const V scale = lane_select(w2 > V{}, rolling * R_eff / w_abs, V{});
    const Vec3<V> brake = scale * (w_rel - dot(w_rel, near.n) * near.n);
    row.t = row.t - brake;
    if constexpr (kAccount) row.lost_rolling += Real(0.5) * a.dt_s * dot(brake, w_rel);
  }
  if constexpr (kAccount) {
    // Each pair is met twice, once from either side: half for each.
    row.stored_n += Real(0.5 * 0.4) * force.F_n_elastic * near.delta;
    row.stored_t += Real(0.25) * force.S_t * dot(xi, xi);
    row.lost_n += Real(0.5) * a.dt_s * force.dashpot_n * force.v_n * force.v_n;
    // See lag_J(): the spring's force is met at the end of the way that changed it.
    const V way = a.dt_s * force.v_n;
    row.lost_t += Real(0.5) * a.law.E_eff_Pa * near.a * way * way;  // half of 1/2 S_n way^2
    row.lost_t -= Real(0.5) * a.dt_s * dot(force.f_tangential, force.v_t);
    const V smaller = lane_select(self.radius < near.radius, self.radius, near.radius);
    const V ratio = near.delta / lane_select(touches, smaller, V{} + Real(1));
    row.deepest = lane_select(ratio > row.deepest, ratio, row.deepest);
    row.stiffness += Real(2) * a.law.E_eff_Pa * near.a + force.S_t;  // S_n + S_t
  }
}

template <typename V>
HOOF_INLINE V kinetic2(const Vec3<V>& v, V weight) {
  return weight * dot(v, v);
}

/// What forces between grains do beyond their work at the velocities before the step, which is what
/// the account takes: exactly, the work is theirs at the mean of the velocities before and after.
template <typename Real, typename V>
HOOF_INLINE V lag_J(const StepArguments<Real>& a, const Row<Real>& row, const Vec3<V>& f_grains,
                    const Vec3<V>& t_grains) {
  const V one = V{} + Real(1);
  const auto alive = row.g.radius > V{};
  const V inertia = Real(0.4) * row.g.mass * row.g.radius * row.g.radius;
  const Vec3<V> g = {V{} + a.gx, V{} + a.gy, V{} + a.gz};
  const V per_inertia = one / lane_select(alive, inertia, one);
  const V power =
      dot(f_grains, (one / row.g.mass) * row.f + g) + per_inertia * dot(t_grains, row.t);
  return lane_select(alive, Real(0.5) * a.dt_s * a.dt_s * power, V{});
}

/// Leapfrog: velocities over the step, then positions; rolling friction brakes the spin and stops
/// it at zero instead of turning it round.
template <typename Real, bool kAccount>
HOOF_INLINE void integrate(const StepArguments<Real>& a, Row<Real>& row) {
  using V = typename Lanes<Real>::V;
  Gathered<Real>& g = row.g;
  const V one = V{} + Real(1);
  const V dt = V{} + a.dt_s;
  const auto alive = g.radius > V{};
  const V per_mass = lane_select(alive, dt / g.mass, V{});
  const V gravity = lane_select(alive, dt, V{});
  g.v.x += per_mass * row.f.x + gravity * a.gx;
  g.v.y += per_mass * row.f.y + gravity * a.gy;
  g.v.z += per_mass * row.f.z + gravity * a.gz;
  const V inertia = Real(0.4) * g.mass * g.radius * g.radius;
  const V per_inertia = lane_select(alive, dt / lane_select(alive, inertia, one), V{});
  g.w = g.w + per_inertia * row.t;
  if constexpr (kAccount) {
    const V left = one - (V{} + a.velocity_factor) * a.velocity_factor;
    row.lost_viscous += Real(0.5) * left * (kinetic2(g.v, g.mass) + kinetic2(g.w, inertia));
  }
  g.v = (V{} + a.velocity_factor) * g.v;
  g.w = (V{} + a.velocity_factor) * g.w;

  const V spin = lane_sqrt(dot(g.w, g.w));
  const V brake = per_inertia * row.rolling * g.radius;
  const V left = spin - brake;
  V keep = lane_select(left > V{}, left / lane_select(spin > V{}, spin, one), V{});
  keep = lane_select(row.rolling > V{}, keep, one);
  if constexpr (kAccount) {
    row.lost_rolling += Real(0.5) * inertia * (one - keep * keep) * spin * spin;
  }
  g.w = keep * g.w;

  const Real steps_x = a.dt_s / a.lsb_x_m, steps_y = a.dt_s / a.lsb_y_m,
             steps_z = a.dt_s / a.lsb_z_m;
  drift<Real>(g.x, g.rx, steps_x * g.v.x);
  drift<Real>(g.y, g.ry, steps_y * g.v.y);
  drift<Real>(g.z, g.rz, steps_z * g.v.z);
}

/// Adds lane after lane, so that the sum does not depend on the number of lanes in a vector.
template <typename Real, typename V>
HOOF_INLINE void add_lanes(double& sum, const V& v) {
  for (int l = 0; l < Lanes<Real>::kCount; ++l) sum += double(v[l]);
}
template <typename Real, typename V>
HOOF_INLINE double largest_lane(const V& v) {
  double largest = 0;
  for (int l = 0; l < Lanes<Real>::kCount; ++l) largest = v[l] > largest ? double(v[l]) : largest;
  return largest;
}

template <typename Real>
HOOF_INLINE void account(const Row<Real>& row, WindowResult& result) {
  add_lanes<Real>(result.contacts.stored_normal_J, row.stored_n);
  add_lanes<Real>(result.contacts.stored_tangential_J, row.stored_t);
  add_lanes<Real>(result.contacts.lost_normal_dashpot_J, row.lost_n);
  add_lanes<Real>(result.contacts.lost_tangential_J, row.lost_t);
  add_lanes<Real>(result.contacts.lost_rolling_J, row.lost_rolling);
  add_lanes<Real>(result.viscous_loss_J, row.lost_viscous);
  const double deepest = largest_lane<Real>(row.deepest);
  if (deepest > result.deepest_ratio) result.deepest_ratio = deepest;
  const double stiffest = largest_lane<Real>(row.stiffness / row.g.mass);
  if (stiffest > result.stiffest_1_s2) result.stiffest_1_s2 = stiffest;
}

/// Speeds met so far. The second keeps what is not finite: a NaN compares false with everything.
template <typename Real>
struct Speeds {
  typename Lanes<Real>::V largest2{}, broken{};
};

template <typename Real, bool kAccount>
HOOF_INLINE void step_part(const StepArguments<Real>& a, std::uint32_t group, int first_lane,
                           Speeds<Real>& speeds, WindowResult& result) {
  using V = typename Lanes<Real>::V;
  constexpr int kCount = Lanes<Real>::kCount;
  constexpr std::uint32_t kAtOnce = 16;  // places in flight between the passes: 9 KiB of stack
  const auto first_row = std::int32_t(group * kLanes) + first_lane;
  const auto row_of = [&](int lane) HOOF_INLINE_LAMBDA { return first_row + lane; };
  Row<Real> row;
  gather_position(a.in, row_of, row.g);
  gather_motion(a.in, row_of, row.g);
  gather_rest(a.in, row_of, row.g);
  row.r3 = row.g.radius * row.g.radius * row.g.radius;

  const std::uint32_t begin = a.slot_begin[group], end = begin + a.slot_count[group];
  // While the forces of this group are computed, the next one's places and the records they name
  // come in.
  const std::uint32_t far = group + 2 < a.group_count ? group + 2 : a.group_count;
  std::uint32_t ahead = a.slot_begin[far];
  const std::uint32_t ahead_end = ahead + a.slot_count[far];
  if (first_lane == 0) {
    for (int l = 0; l < kLanes; ++l) {
      __builtin_prefetch(&a.in[far * kLanes + l]);
      __builtin_prefetch(&a.out[far * kLanes + l], 1);
    }
  }
  const auto fetch_ahead = [&] {
    const EllSlot<Real>& next = a.slots[ahead++];
    for (int l = 0; l < kCount; ++l) __builtin_prefetch(&a.in[next.neighbour[first_lane + l]]);
    __builtin_prefetch(next.xi_x + first_lane);
    __builtin_prefetch(next.xi_y + first_lane);
    __builtin_prefetch(next.xi_z + first_lane);
  };
  Near<Real> near[kAtOnce];
  for (std::uint32_t first = begin; first < end; first += kAtOnce) {
    const std::uint32_t last = end - first < kAtOnce ? end : first + kAtOnce;
    std::uint32_t found = 0;
    for (std::uint32_t slot = first; slot < last; ++slot) {
      found += look_at(a, slot, first_lane, row, near[found]);
    }
    for (std::uint32_t i = 0; i < found; ++i) take_roots(a, row, near[i]);
    for (std::uint32_t i = 0; i < found; ++i) {
      if (ahead < ahead_end) fetch_ahead();
      add_force<Real, kAccount>(a, near[i], first_lane, row);
    }
  }
  while (ahead < ahead_end) fetch_ahead();
  const Vec3<V> f_grains = row.f, t_grains = row.t;
  if (const std::int32_t b = a.boundary_of_group[group]; b >= 0) {
    const BoundaryForce<Real>& e = a.boundary[b];
    row.f = row.f + Vec3<V>{load<V>(e.fx + first_lane), load<V>(e.fy + first_lane),
                            load<V>(e.fz + first_lane)};
    row.t = row.t + Vec3<V>{load<V>(e.tx + first_lane), load<V>(e.ty + first_lane),
                            load<V>(e.tz + first_lane)};
    row.rolling += load<V>(e.rolling_N + first_lane);
  }
  if constexpr (kAccount) row.lost_t -= lag_J(a, row, f_grains, t_grains);
  integrate<Real, kAccount>(a, row);
  store_rows(row.g, a.out, row_of);
  const V v2 = dot(row.g.v, row.g.v);
  speeds.largest2 = lane_select(v2 > speeds.largest2, v2, speeds.largest2);
  speeds.broken += v2 - v2;
  if constexpr (kAccount) account<Real>(row, result);
}

template <typename Real, bool kAccount>
HOOF_INLINE void step_windows(const StepArguments<Real>& a, std::uint32_t begin,
                              std::uint32_t end) {
  for (std::uint32_t window = begin; window < end; ++window) {
    WindowResult result;
    Speeds<Real> speeds;
    const std::uint32_t first = window * kGroupsPerWindow;
    const std::uint32_t last =
        first + kGroupsPerWindow < a.group_count ? first + kGroupsPerWindow : a.group_count;
    for (std::uint32_t group = first; group < last; ++group) {
      for (int lane = 0; lane < kLanes; lane += Lanes<Real>::kCount) {
        step_part<Real, kAccount>(a, group, lane, speeds, result);
      }
    }
    result.fastest_m_s = __builtin_sqrt(largest_lane<Real>(speeds.largest2));
    add_lanes<Real>(result.fastest_m_s, speeds.broken);
    a.results[window] = result;
  }
}

void step_mixed(const StepArguments<float>& a, std::uint32_t begin, std::uint32_t end);
void step_double(const StepArguments<double>& a, std::uint32_t begin, std::uint32_t end);

void step_mixed(const StepArguments<float>& a, std::uint32_t begin, std::uint32_t end) {
  return a.account ? step_windows<float, true>(a, begin, end)
                   : step_windows<float, false>(a, begin, end);
}
void step_double(const StepArguments<double>& a, std::uint32_t begin, std::uint32_t end) {
  return a.account ? step_windows<double, true>(a, begin, end)
                   : step_windows<double, false>(a, begin, end);
}

}  // namespace HOOF_ISA
}  // namespace hoof::sim
