// The step in lanes. Included once per instruction set with HOOF_ISA (a namespace) and
// HOOF_VECTOR_BYTES set; includes nothing that has inline functions of its own, so that no code of
// a wider instruction set can leak into the rest of the program.
//
// A group has 16 rows on every instruction set; a narrower one takes them in 2 to 8 parts. Rows do
// not talk to each other, so the parts change no bit.
#pragma once

#if HOOF_VECTOR_BYTES == 64
#include <immintrin.h>
#elif HOOF_VECTOR_BYTES == 32
#include <immintrin.h>
#else
#include <emmintrin.h>
#endif

#include "sim/dem/step_kernel.h"

namespace hoof::sim {
namespace HOOF_ISA {

template <typename Real>
struct Lanes;

template <>
struct Lanes<float> {
  static constexpr int kCount = HOOF_VECTOR_BYTES / 4;
  typedef float V __attribute__((vector_size(HOOF_VECTOR_BYTES)));
  typedef std::int32_t I __attribute__((vector_size(HOOF_VECTOR_BYTES)));
  typedef std::uint32_t U __attribute__((vector_size(HOOF_VECTOR_BYTES)));
  typedef std::int32_t Mask __attribute__((vector_size(HOOF_VECTOR_BYTES)));
};

template <>
struct Lanes<double> {
  static constexpr int kCount = HOOF_VECTOR_BYTES / 8;
  typedef double V __attribute__((vector_size(HOOF_VECTOR_BYTES)));
  typedef std::int32_t I __attribute__((vector_size(HOOF_VECTOR_BYTES / 2)));
  typedef std::uint32_t U __attribute__((vector_size(HOOF_VECTOR_BYTES / 2)));
  typedef std::int64_t Mask __attribute__((vector_size(HOOF_VECTOR_BYTES)));
};

typedef Lanes<float>::V VF;
typedef Lanes<double>::V VD;

}  // namespace HOOF_ISA

#if HOOF_VECTOR_BYTES == 64
template <>
HOOF_INLINE HOOF_ISA::VF lane_sqrt<HOOF_ISA::VF>(HOOF_ISA::VF a) {
  return (HOOF_ISA::VF)_mm512_sqrt_ps((__m512)a);
}
template <>
HOOF_INLINE HOOF_ISA::VD lane_sqrt<HOOF_ISA::VD>(HOOF_ISA::VD a) {
  return (HOOF_ISA::VD)_mm512_sqrt_pd((__m512d)a);
}
#elif HOOF_VECTOR_BYTES == 32
template <>
HOOF_INLINE HOOF_ISA::VF lane_sqrt<HOOF_ISA::VF>(HOOF_ISA::VF a) {
  return (HOOF_ISA::VF)_mm256_sqrt_ps((__m256)a);
}
template <>
HOOF_INLINE HOOF_ISA::VD lane_sqrt<HOOF_ISA::VD>(HOOF_ISA::VD a) {
  return (HOOF_ISA::VD)_mm256_sqrt_pd((__m256d)a);
}
#else
template <>
HOOF_INLINE HOOF_ISA::VF lane_sqrt<HOOF_ISA::VF>(HOOF_ISA::VF a) {
  return (HOOF_ISA::VF)_mm_sqrt_ps((__m128)a);
}
template <>
HOOF_INLINE HOOF_ISA::VD lane_sqrt<HOOF_ISA::VD>(HOOF_ISA::VD a) {
  return (HOOF_ISA::VD)_mm_sqrt_pd((__m128d)a);
}
#endif

namespace HOOF_ISA {

template <typename V>
HOOF_INLINE V load(const void* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
template <typename V>
HOOF_INLINE void store(void* p, const V& v) {
  __builtin_memcpy(p, &v, sizeof v);
}

/// One bit per lane, lane 0 lowest.
#if HOOF_VECTOR_BYTES == 64
HOOF_INLINE std::uint32_t mask_bits(Lanes<float>::Mask m) {
  return _mm512_movepi32_mask((__m512i)m);
}
HOOF_INLINE std::uint32_t mask_bits(Lanes<double>::Mask m) {
  return _mm512_movepi64_mask((__m512i)m);
}
#elif HOOF_VECTOR_BYTES == 32
HOOF_INLINE std::uint32_t mask_bits(Lanes<float>::Mask m) {
  return std::uint32_t(_mm256_movemask_ps((__m256)m));
}
HOOF_INLINE std::uint32_t mask_bits(Lanes<double>::Mask m) {
  return std::uint32_t(_mm256_movemask_pd((__m256d)m));
}
#else
HOOF_INLINE std::uint32_t mask_bits(Lanes<float>::Mask m) {
  return std::uint32_t(_mm_movemask_ps((__m128)m));
}
HOOF_INLINE std::uint32_t mask_bits(Lanes<double>::Mask m) {
  return std::uint32_t(_mm_movemask_pd((__m128d)m));
}
#endif

}  // namespace HOOF_ISA

template <>
HOOF_INLINE bool any_lane<HOOF_ISA::Lanes<float>::Mask>(HOOF_ISA::Lanes<float>::Mask mask) {
  return HOOF_ISA::mask_bits(mask) != 0;
}
template <>
HOOF_INLINE bool any_lane<HOOF_ISA::Lanes<double>::Mask>(HOOF_ISA::Lanes<double>::Mask mask) {
  return HOOF_ISA::mask_bits(mask) != 0;
}

namespace HOOF_ISA {

// Four words of each of kCount records <-> four vectors, by 4 x 4 transposes of 128-bit pieces:
// piece p of vector r belongs to lane 4 p + r. Moves bits only.
#if HOOF_VECTOR_BYTES == 64
typedef __m512 Wide;
HOOF_INLINE Wide unpack_low(Wide a, Wide b) {
  return _mm512_unpacklo_ps(a, b);
}
HOOF_INLINE Wide unpack_high(Wide a, Wide b) {
  return _mm512_unpackhi_ps(a, b);
}
HOOF_INLINE Wide low_halves(Wide a, Wide b) {
  return _mm512_shuffle_ps(a, b, 0x44);
}
HOOF_INLINE Wide high_halves(Wide a, Wide b) {
  return _mm512_shuffle_ps(a, b, 0xEE);
}
template <typename At>
HOOF_INLINE Wide join_pieces(int r, const At& at) {
  Wide v = _mm512_castps128_ps512(at(r));
  v = _mm512_insertf32x4(v, at(r + 4), 1);
  v = _mm512_insertf32x4(v, at(r + 8), 2);
  return _mm512_insertf32x4(v, at(r + 12), 3);
}
template <typename Put>
HOOF_INLINE void split_pieces(int r, Wide v, const Put& put) {
  put(r, _mm512_castps512_ps128(v));
  put(r + 4, _mm512_extractf32x4_ps(v, 1));
  put(r + 8, _mm512_extractf32x4_ps(v, 2));
  put(r + 12, _mm512_extractf32x4_ps(v, 3));
}
#elif HOOF_VECTOR_BYTES == 32
typedef __m256 Wide;
HOOF_INLINE Wide unpack_low(Wide a, Wide b) {
  return _mm256_unpacklo_ps(a, b);
}
HOOF_INLINE Wide unpack_high(Wide a, Wide b) {
  return _mm256_unpackhi_ps(a, b);
}
HOOF_INLINE Wide low_halves(Wide a, Wide b) {
  return _mm256_shuffle_ps(a, b, 0x44);
}
HOOF_INLINE Wide high_halves(Wide a, Wide b) {
  return _mm256_shuffle_ps(a, b, 0xEE);
}
template <typename At>
HOOF_INLINE Wide join_pieces(int r, const At& at) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(at(r)), at(r + 4), 1);
}
template <typename Put>
HOOF_INLINE void split_pieces(int r, Wide v, const Put& put) {
  put(r, _mm256_castps256_ps128(v));
  put(r + 4, _mm256_extractf128_ps(v, 1));
}
#else
typedef __m128 Wide;
HOOF_INLINE Wide unpack_low(Wide a, Wide b) {
  return _mm_unpacklo_ps(a, b);
}
HOOF_INLINE Wide unpack_high(Wide a, Wide b) {
  return _mm_unpackhi_ps(a, b);
}
HOOF_INLINE Wide low_halves(Wide a, Wide b) {
  return _mm_shuffle_ps(a, b, 0x44);
}
HOOF_INLINE Wide high_halves(Wide a, Wide b) {
  return _mm_shuffle_ps(a, b, 0xEE);
}
template <typename At>
HOOF_INLINE Wide join_pieces(int r, const At& at) {
  return at(r);
}
template <typename Put>
HOOF_INLINE void split_pieces(int r, Wide v, const Put& put) {
  put(r, v);
}
#endif

HOOF_INLINE void transpose(Wide& a, Wide& b, Wide& c, Wide& d) {
  const Wide ab_low = unpack_low(a, b), ab_high = unpack_high(a, b);
  const Wide cd_low = unpack_low(c, d), cd_high = unpack_high(c, d);
  a = low_halves(ab_low, cd_low), b = high_halves(ab_low, cd_low);
  c = low_halves(ab_high, cd_high), d = high_halves(ab_high, cd_high);
}

template <typename RowOf>
HOOF_INLINE void load_quad(const GrainRecord<float>* records, const RowOf& row_of, int quad, VF& a,
                           VF& b, VF& c, VF& d) {
  const auto at = [&](int lane) {
    return _mm_load_ps(reinterpret_cast<const float*>(records + row_of(lane)) + 4 * quad);
  };
  Wide r0 = join_pieces(0, at), r1 = join_pieces(1, at), r2 = join_pieces(2, at),
       r3 = join_pieces(3, at);
  transpose(r0, r1, r2, r3);
  a = (VF)r0, b = (VF)r1, c = (VF)r2, d = (VF)r3;
}

HOOF_INLINE void store_quad(GrainRecord<float>* records, int quad, VF a, VF b, VF c, VF d) {
  Wide r0 = (Wide)a, r1 = (Wide)b, r2 = (Wide)c, r3 = (Wide)d;
  transpose(r0, r1, r2, r3);
  const auto put = [&](int lane, __m128 v) {
    _mm_store_ps(reinterpret_cast<float*>(records + lane) + 4 * quad, v);
  };
  split_pieces(0, r0, put), split_pieces(1, r1, put), split_pieces(2, r2, put),
      split_pieces(3, r3, put);
}

/// kCount grains, one a lane.
template <typename Real>
struct Gathered {
  using V = typename Lanes<Real>::V;
  using I = typename Lanes<Real>::I;
  I x{}, y{}, z{};
  V radius{}, mass{};
  V rx{}, ry{}, rz{};
  Vec3<V> v{}, w{};
  I id{};
};

// In mixed precision the part below one step (0.1 nm in the paper's box) is left out of distances:
// it is some 4e-5 of the overlap under a grain's own weight, below single precision's own error.
template <typename RowOf>
HOOF_INLINE void gather_position(const GrainRecord<float>* r, const RowOf& row_of,
                                 Gathered<float>& g) {
  VF x, y, z;
  load_quad(r, row_of, 0, x, y, z, g.radius);
  g.x = (Lanes<float>::I)x, g.y = (Lanes<float>::I)y, g.z = (Lanes<float>::I)z;
}
template <typename RowOf>
HOOF_INLINE void gather_motion(const GrainRecord<float>* r, const RowOf& row_of,
                               Gathered<float>& g) {
  VF id;
  load_quad(r, row_of, 1, g.v.x, g.v.y, g.v.z, g.mass);
  load_quad(r, row_of, 2, g.w.x, g.w.y, g.w.z, id);
  g.id = (Lanes<float>::I)id;
}
template <typename RowOf>
HOOF_INLINE void gather_rest(const GrainRecord<float>* r, const RowOf& row_of, Gathered<float>& g) {
  VF pad;
  load_quad(r, row_of, 3, g.rx, g.ry, g.rz, pad);
}
HOOF_INLINE void store_rows(const Gathered<float>& g, GrainRecord<float>* out) {
  store_quad(out, 0, (VF)g.x, (VF)g.y, (VF)g.z, g.radius);
  store_quad(out, 1, g.v.x, g.v.y, g.v.z, g.mass);
  store_quad(out, 2, g.w.x, g.w.y, g.w.z, (VF)g.id);
  store_quad(out, 3, g.rx, g.ry, g.rz, VF{});
}

template <typename RowOf>
HOOF_INLINE void gather_position(const GrainRecord<double>* r, const RowOf& row_of,
                                 Gathered<double>& g) {
  for (int l = 0; l < Lanes<double>::kCount; ++l) {
    const GrainRecord<double>& p = r[row_of(l)];
    g.x[l] = p.x, g.y[l] = p.y, g.z[l] = p.z, g.radius[l] = p.radius_m;
    g.rx[l] = p.rx, g.ry[l] = p.ry, g.rz[l] = p.rz;
  }
}
template <typename RowOf>
HOOF_INLINE void gather_motion(const GrainRecord<double>* r, const RowOf& row_of,
                               Gathered<double>& g) {
  for (int l = 0; l < Lanes<double>::kCount; ++l) {
    const GrainRecord<double>& p = r[row_of(l)];
    g.v.x[l] = p.vx, g.v.y[l] = p.vy, g.v.z[l] = p.vz, g.mass[l] = p.mass_kg;
    g.w.x[l] = p.wx, g.w.y[l] = p.wy, g.w.z[l] = p.wz;
    g.id[l] = std::int32_t(p.id);
  }
}
template <typename RowOf>
HOOF_INLINE void gather_rest(const GrainRecord<double>*, const RowOf&, Gathered<double>&) {}
HOOF_INLINE void store_rows(const Gathered<double>& g, GrainRecord<double>* out) {
  for (int l = 0; l < Lanes<double>::kCount; ++l) {
    out[l] = {g.x[l],   g.y[l],    g.z[l],   g.radius[l], g.v.x[l], g.v.y[l],
              g.v.z[l], g.mass[l], g.w.x[l], g.w.y[l],    g.w.z[l], std::uint32_t(g.id[l]),
              g.rx[l],  g.ry[l],   g.rz[l]};
  }
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

/// Moves a coordinate by `steps` (of the lsb, any real number); the part below one step is kept.
template <typename Real>
HOOF_INLINE void drift(typename Lanes<Real>::I& x, typename Lanes<Real>::V& rest,
                       typename Lanes<Real>::V steps) {
  using V = typename Lanes<Real>::V;
  using I = typename Lanes<Real>::I;
  using U = typename Lanes<Real>::U;
  const V sum = steps + rest;
  // Truncation is enough: the rest then lies in (-1, 1) and nothing is lost.
  const I whole = __builtin_convertvector(sum, I);
  rest = sum - __builtin_convertvector(whole, V);
  x = (I)((U)x + (U)whole);
}

template <typename Real>
struct Row {
  using V = typename Lanes<Real>::V;
  Gathered<Real> g;
  Vec3<V> f{}, t{};  // force N, torque Nm
  V rolling{};       // kOwnSpin: sum of mu_r F_n; the torque is this times the radius
};

/// Force of the k-th neighbours on the lanes, kept on their lists' places.
template <typename Real>
HOOF_INLINE void add_slot(const StepArguments<Real>& a, EllSlot<Real>& slot,
                          std::uint16_t& touching, int first_lane, Row<Real>& row) {
  using V = typename Lanes<Real>::V;
  constexpr int kCount = Lanes<Real>::kCount;
  const auto row_of = [&](int lane) { return slot.neighbour[first_lane + lane]; };
  Gathered<Real> other;
  gather_position(a.in, row_of, other);
  const Gathered<Real>& self = row.g;
  Vec3<V> d = {difference_m<Real>(self.x, other.x, a.lsb_x_m),
               difference_m<Real>(self.y, other.y, a.lsb_y_m),
               difference_m<Real>(self.z, other.z, a.lsb_z_m)};
  if constexpr (sizeof(Real) == 8) {
    d.x += a.lsb_x_m * (self.rx - other.rx);
    d.y += a.lsb_y_m * (self.ry - other.ry);
    d.z += a.lsb_z_m * (self.rz - other.rz);
  }
  const V reach = self.radius + other.radius;
  const V d2 = dot(d, d);
  // An empty place names the row itself, at distance exactly zero; two grains never are.
  const auto touches = (d2 < reach * reach) & (d2 > V{});
  const std::uint32_t now = mask_bits(touches);
  constexpr std::uint32_t all = (1u << kCount) - 1u;
  const std::uint32_t before = (std::uint32_t(touching) >> first_lane) & all;
  if ((now | before) == 0) return;
  touching = std::uint16_t((touching & ~(all << first_lane)) | (now << first_lane));

  Vec3<V> xi = {load<V>(slot.xi_x + first_lane), load<V>(slot.xi_y + first_lane),
                load<V>(slot.xi_z + first_lane)};
  gather_motion(a.in, row_of, other);
  const V one = V{} + Real(1);
  const V dist = lane_sqrt(lane_select(touches, d2, one));
  Touch<V> c;
  c.delta = lane_select(touches, reach - dist, V{});
  c.n = (one / dist) * d;
  // One division for both: R* = r_i r_j / (r_i + r_j), m* likewise.
  const V masses = self.mass + other.mass;
  const V per_sums = one / (reach * masses);
  c.R_eff = self.radius * other.radius * (masses * per_sums);
  c.m_eff = self.mass * other.mass * (reach * per_sums);
  c.v_rel = self.v - other.v;
  const V c_i = self.radius - Real(0.5) * c.delta;
  const V c_j = other.radius - Real(0.5) * c.delta;
  c.w_arm = c_i * self.w + c_j * other.w;
  TouchForce<V> force = touch_force<V, Real>(a.law, a.cap, a.dt_s, c, xi);

  const auto keep = [&](V& v) { v = lane_select(touches, v, V{}); };
  keep(xi.x), keep(xi.y), keep(xi.z);
  store(slot.xi_x + first_lane, xi.x);
  store(slot.xi_y + first_lane, xi.y);
  store(slot.xi_z + first_lane, xi.z);
  Vec3<V> f = force.f_normal + force.f_tangential;
  keep(f.x), keep(f.y), keep(f.z);
  const Vec3<V> torque = c_i * cross(force.f_tangential, c.n);  // (-c_i n) x f_t
  row.f = row.f + f;
  row.t.x += lane_select(touches, torque.x, V{});
  row.t.y += lane_select(touches, torque.y, V{});
  row.t.z += lane_select(touches, torque.z, V{});
  const V rolling = lane_select(touches, a.law.mu_r * force.F_n_elastic, V{});
  if (a.rolling == RollingLaw::kOwnSpin) {
    row.rolling += rolling;
  } else {
    const Vec3<V> w_rel = self.w - other.w;
    const V w2 = dot(w_rel, w_rel);
    const V w_abs = lane_sqrt(lane_select(w2 > V{}, w2, one));
    const V scale = lane_select(w2 > V{}, rolling * c.R_eff / w_abs, V{});
    row.t = row.t - scale * (w_rel - dot(w_rel, c.n) * c.n);
  }
}

/// Leapfrog: velocities over the step, then positions; rolling friction brakes the spin and stops
/// it at zero instead of turning it round.
template <typename Real>
HOOF_INLINE void integrate(const StepArguments<Real>& a, Row<Real>& row) {
  using V = typename Lanes<Real>::V;
  Gathered<Real>& g = row.g;
  const V dt = V{} + a.dt_s;
  const auto alive = g.radius > V{};
  const V per_mass = lane_select(alive, dt / g.mass, V{});
  const V gravity = lane_select(alive, dt, V{});
  g.v.x += per_mass * row.f.x + gravity * a.gx;
  g.v.y += per_mass * row.f.y + gravity * a.gy;
  g.v.z += per_mass * row.f.z + gravity * a.gz;

  g.v = (V{} + a.velocity_factor) * g.v;

  const V inertia = Real(0.4) * g.mass * g.radius * g.radius;
  const V per_inertia = lane_select(alive, dt / lane_select(alive, inertia, V{} + Real(1)), V{});
  g.w = (V{} + a.velocity_factor) * (g.w + per_inertia * row.t);
  const V spin = lane_sqrt(dot(g.w, g.w));
  const V brake = per_inertia * row.rolling * g.radius;
  const V left = spin - brake;
  const V keep = lane_select(left > V{}, left / lane_select(spin > V{}, spin, V{} + Real(1)), V{});
  g.w = lane_select(row.rolling > V{}, keep, V{} + Real(1)) * g.w;

  const Real steps_x = a.dt_s / a.lsb_x_m, steps_y = a.dt_s / a.lsb_y_m,
             steps_z = a.dt_s / a.lsb_z_m;
  drift<Real>(g.x, g.rx, steps_x * g.v.x);
  drift<Real>(g.y, g.ry, steps_y * g.v.y);
  drift<Real>(g.z, g.rz, steps_z * g.v.z);
}

template <typename Real>
HOOF_INLINE Real step_part(const StepArguments<Real>& a, std::uint32_t group, int first_lane) {
  using V = typename Lanes<Real>::V;
  constexpr int kCount = Lanes<Real>::kCount;
  constexpr int kAhead = 6;  // slots; best on a trial kernel of the same layout (Zen 5)
  const auto first_row = std::int32_t(group * kLanes) + first_lane;
  Row<Real> row;
  const auto row_of = [&](int lane) { return first_row + lane; };
  gather_position(a.in, row_of, row.g);
  gather_motion(a.in, row_of, row.g);
  gather_rest(a.in, row_of, row.g);
  const std::uint32_t end = a.slot_begin[group + 1];
  const std::uint32_t last = a.slot_begin[group + 2];  // the next group's too, for prefetching
  for (std::uint32_t k = a.slot_begin[group]; k < end; ++k) {
    if (k + kAhead < last) {
      const std::int32_t* next = a.slots[k + kAhead].neighbour + first_lane;
      for (int l = 0; l < kCount; ++l) __builtin_prefetch(&a.in[next[l]]);
    }
    add_slot(a, a.slots[k], a.touching[k], first_lane, row);
  }
  if (const std::int32_t b = a.boundary_of_group[group]; b >= 0) {
    const BoundaryForce<Real>& e = a.boundary[b];
    row.f = row.f + Vec3<V>{load<V>(e.fx + first_lane), load<V>(e.fy + first_lane),
                            load<V>(e.fz + first_lane)};
    row.t = row.t + Vec3<V>{load<V>(e.tx + first_lane), load<V>(e.ty + first_lane),
                            load<V>(e.tz + first_lane)};
    row.rolling += load<V>(e.rolling_N + first_lane);
  }
  integrate(a, row);
  store_rows(row.g, a.out + first_row);
  const V v2 = dot(row.g.v, row.g.v);
  Real fastest = 0;
  for (int l = 0; l < kCount; ++l) fastest = v2[l] <= fastest ? fastest : v2[l];  // NaN gets out
  return fastest;
}

template <typename Real>
HOOF_INLINE Real step_groups(const StepArguments<Real>& a, std::uint32_t begin, std::uint32_t end) {
  Real fastest = 0;
  for (std::uint32_t group = begin; group < end; ++group) {
    for (int lane = 0; lane < kLanes; lane += Lanes<Real>::kCount) {
      const Real v2 = step_part(a, group, lane);
      fastest = v2 <= fastest ? fastest : v2;
    }
  }
  return fastest;
}

float step_mixed(const StepArguments<float>& a, std::uint32_t begin, std::uint32_t end);
double step_double(const StepArguments<double>& a, std::uint32_t begin, std::uint32_t end);

float step_mixed(const StepArguments<float>& a, std::uint32_t begin, std::uint32_t end) {
  return step_groups(a, begin, end);
}
double step_double(const StepArguments<double>& a, std::uint32_t begin, std::uint32_t end) {
  return step_groups(a, begin, end);
}

}  // namespace HOOF_ISA
}  // namespace hoof::sim
