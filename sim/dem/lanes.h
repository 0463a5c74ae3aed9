// Vectors of lanes for one instruction set, HOOF_ISA with HOOF_VECTOR_BYTES, and the moves of
// records into and out of them. Includes nothing that has inline functions of its own, so that no
// code of a wider instruction set can leak into the rest of the program.
#pragma once

#if HOOF_VECTOR_BYTES == 64
#include <immintrin.h>
#elif HOOF_VECTOR_BYTES == 32
#include <immintrin.h>
#else
#include <emmintrin.h>
#endif

#include "sim/dem/contact_law.h"
#include "sim/dem/grain_record.h"

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
  typedef std::int64_t I __attribute__((vector_size(HOOF_VECTOR_BYTES)));
  typedef std::uint64_t U __attribute__((vector_size(HOOF_VECTOR_BYTES)));
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

// Four words of each of kCount records <-> four vectors, one word a lane, by 4 x 4 transposes.
// Moves bits only. quad_pointer(lane) is where a lane's four words are.
#if HOOF_VECTOR_BYTES == 64

template <typename At>
HOOF_INLINE void load_quad(const At& at, VF& a, VF& b, VF& c, VF& d) {
  const auto join = [&](int r) HOOF_INLINE_LAMBDA {
    __m512 v = _mm512_castps128_ps512(_mm_load_ps(at(r)));
    v = _mm512_insertf32x4(v, _mm_load_ps(at(r + 4)), 1);
    v = _mm512_insertf32x4(v, _mm_load_ps(at(r + 8)), 2);
    return _mm512_insertf32x4(v, _mm_load_ps(at(r + 12)), 3);
  };
  const __m512 r0 = join(0), r1 = join(1), r2 = join(2), r3 = join(3);
  const __m512 low01 = _mm512_unpacklo_ps(r0, r1), high01 = _mm512_unpackhi_ps(r0, r1);
  const __m512 low23 = _mm512_unpacklo_ps(r2, r3), high23 = _mm512_unpackhi_ps(r2, r3);
  a = (VF)_mm512_shuffle_ps(low01, low23, 0x44), b = (VF)_mm512_shuffle_ps(low01, low23, 0xEE);
  c = (VF)_mm512_shuffle_ps(high01, high23, 0x44), d = (VF)_mm512_shuffle_ps(high01, high23, 0xEE);
}
template <typename At>
HOOF_INLINE void store_quad(const At& at, VF a, VF b, VF c, VF d) {
  const __m512 low01 = _mm512_unpacklo_ps((__m512)a, (__m512)b);
  const __m512 high01 = _mm512_unpackhi_ps((__m512)a, (__m512)b);
  const __m512 low23 = _mm512_unpacklo_ps((__m512)c, (__m512)d);
  const __m512 high23 = _mm512_unpackhi_ps((__m512)c, (__m512)d);
  const auto put = [&](int r, __m512 v) HOOF_INLINE_LAMBDA {
    _mm_store_ps(at(r), _mm512_castps512_ps128(v));
    _mm_store_ps(at(r + 4), _mm512_extractf32x4_ps(v, 1));
    _mm_store_ps(at(r + 8), _mm512_extractf32x4_ps(v, 2));
    _mm_store_ps(at(r + 12), _mm512_extractf32x4_ps(v, 3));
  };
  put(0, _mm512_shuffle_ps(low01, low23, 0x44)), put(1, _mm512_shuffle_ps(low01, low23, 0xEE));
  put(2, _mm512_shuffle_ps(high01, high23, 0x44)), put(3, _mm512_shuffle_ps(high01, high23, 0xEE));
}

/// Halves of 128 bits: x0 y0 x2 y2, and x1 y1 x3 y3.
HOOF_INLINE __m512d even_halves(__m512d x, __m512d y) {
  return _mm512_permutex2var_pd(x, _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), y);
}
HOOF_INLINE __m512d odd_halves(__m512d x, __m512d y) {
  return _mm512_permutex2var_pd(x, _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15), y);
}
template <typename At>
HOOF_INLINE void load_quad(const At& at, VD& a, VD& b, VD& c, VD& d) {
  const auto join = [&](int r) HOOF_INLINE_LAMBDA {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(at(r))),
                              _mm256_load_pd(at(r + 4)), 1);
  };
  const __m512d r0 = join(0), r1 = join(1), r2 = join(2), r3 = join(3);
  const __m512d low01 = _mm512_unpacklo_pd(r0, r1), high01 = _mm512_unpackhi_pd(r0, r1);
  const __m512d low23 = _mm512_unpacklo_pd(r2, r3), high23 = _mm512_unpackhi_pd(r2, r3);
  a = (VD)even_halves(low01, low23), b = (VD)even_halves(high01, high23);
  c = (VD)odd_halves(low01, low23), d = (VD)odd_halves(high01, high23);
}
template <typename At>
HOOF_INLINE void store_quad(const At& at, VD a, VD b, VD c, VD d) {
  const __m512d low01 = _mm512_unpacklo_pd((__m512d)a, (__m512d)b);
  const __m512d high01 = _mm512_unpackhi_pd((__m512d)a, (__m512d)b);
  const __m512d low23 = _mm512_unpacklo_pd((__m512d)c, (__m512d)d);
  const __m512d high23 = _mm512_unpackhi_pd((__m512d)c, (__m512d)d);
  const auto put = [&](int r, __m512d v) HOOF_INLINE_LAMBDA {
    _mm256_store_pd(at(r), _mm512_castpd512_pd256(v));
    _mm256_store_pd(at(r + 4), _mm512_extractf64x4_pd(v, 1));
  };
  put(0, even_halves(low01, low23)), put(1, even_halves(high01, high23));
  put(2, odd_halves(low01, low23)), put(3, odd_halves(high01, high23));
}

#elif HOOF_VECTOR_BYTES == 32

template <typename At>
HOOF_INLINE void load_quad(const At& at, VF& a, VF& b, VF& c, VF& d) {
  const auto join = [&](int r) HOOF_INLINE_LAMBDA {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(at(r))), _mm_load_ps(at(r + 4)),
                                1);
  };
  const __m256 r0 = join(0), r1 = join(1), r2 = join(2), r3 = join(3);
  const __m256 low01 = _mm256_unpacklo_ps(r0, r1), high01 = _mm256_unpackhi_ps(r0, r1);
  const __m256 low23 = _mm256_unpacklo_ps(r2, r3), high23 = _mm256_unpackhi_ps(r2, r3);
  a = (VF)_mm256_shuffle_ps(low01, low23, 0x44), b = (VF)_mm256_shuffle_ps(low01, low23, 0xEE);
  c = (VF)_mm256_shuffle_ps(high01, high23, 0x44), d = (VF)_mm256_shuffle_ps(high01, high23, 0xEE);
}
template <typename At>
HOOF_INLINE void store_quad(const At& at, VF a, VF b, VF c, VF d) {
  const __m256 low01 = _mm256_unpacklo_ps((__m256)a, (__m256)b);
  const __m256 high01 = _mm256_unpackhi_ps((__m256)a, (__m256)b);
  const __m256 low23 = _mm256_unpacklo_ps((__m256)c, (__m256)d);
  const __m256 high23 = _mm256_unpackhi_ps((__m256)c, (__m256)d);
  const auto put = [&](int r, __m256 v) HOOF_INLINE_LAMBDA {
    _mm_store_ps(at(r), _mm256_castps256_ps128(v));
    _mm_store_ps(at(r + 4), _mm256_extractf128_ps(v, 1));
  };
  put(0, _mm256_shuffle_ps(low01, low23, 0x44)), put(1, _mm256_shuffle_ps(low01, low23, 0xEE));
  put(2, _mm256_shuffle_ps(high01, high23, 0x44)), put(3, _mm256_shuffle_ps(high01, high23, 0xEE));
}
template <typename At>
HOOF_INLINE void load_quad(const At& at, VD& a, VD& b, VD& c, VD& d) {
  const __m256d r0 = _mm256_load_pd(at(0)), r1 = _mm256_load_pd(at(1));
  const __m256d r2 = _mm256_load_pd(at(2)), r3 = _mm256_load_pd(at(3));
  const __m256d low01 = _mm256_unpacklo_pd(r0, r1), high01 = _mm256_unpackhi_pd(r0, r1);
  const __m256d low23 = _mm256_unpacklo_pd(r2, r3), high23 = _mm256_unpackhi_pd(r2, r3);
  a = (VD)_mm256_permute2f128_pd(low01, low23, 0x20);
  b = (VD)_mm256_permute2f128_pd(high01, high23, 0x20);
  c = (VD)_mm256_permute2f128_pd(low01, low23, 0x31);
  d = (VD)_mm256_permute2f128_pd(high01, high23, 0x31);
}
template <typename At>
HOOF_INLINE void store_quad(const At& at, VD a, VD b, VD c, VD d) {
  const __m256d low01 = _mm256_unpacklo_pd((__m256d)a, (__m256d)b);
  const __m256d high01 = _mm256_unpackhi_pd((__m256d)a, (__m256d)b);
  const __m256d low23 = _mm256_unpacklo_pd((__m256d)c, (__m256d)d);
  const __m256d high23 = _mm256_unpackhi_pd((__m256d)c, (__m256d)d);
  _mm256_store_pd(at(0), _mm256_permute2f128_pd(low01, low23, 0x20));
  _mm256_store_pd(at(1), _mm256_permute2f128_pd(high01, high23, 0x20));
  _mm256_store_pd(at(2), _mm256_permute2f128_pd(low01, low23, 0x31));
  _mm256_store_pd(at(3), _mm256_permute2f128_pd(high01, high23, 0x31));
}

#else

template <typename At>
HOOF_INLINE void load_quad(const At& at, VF& a, VF& b, VF& c, VF& d) {
  const __m128 r0 = _mm_load_ps(at(0)), r1 = _mm_load_ps(at(1));
  const __m128 r2 = _mm_load_ps(at(2)), r3 = _mm_load_ps(at(3));
  const __m128 low01 = _mm_unpacklo_ps(r0, r1), high01 = _mm_unpackhi_ps(r0, r1);
  const __m128 low23 = _mm_unpacklo_ps(r2, r3), high23 = _mm_unpackhi_ps(r2, r3);
  a = (VF)_mm_shuffle_ps(low01, low23, 0x44), b = (VF)_mm_shuffle_ps(low01, low23, 0xEE);
  c = (VF)_mm_shuffle_ps(high01, high23, 0x44), d = (VF)_mm_shuffle_ps(high01, high23, 0xEE);
}
template <typename At>
HOOF_INLINE void store_quad(const At& at, VF a, VF b, VF c, VF d) {
  const __m128 low01 = _mm_unpacklo_ps((__m128)a, (__m128)b);
  const __m128 high01 = _mm_unpackhi_ps((__m128)a, (__m128)b);
  const __m128 low23 = _mm_unpacklo_ps((__m128)c, (__m128)d);
  const __m128 high23 = _mm_unpackhi_ps((__m128)c, (__m128)d);
  _mm_store_ps(at(0), _mm_shuffle_ps(low01, low23, 0x44));
  _mm_store_ps(at(1), _mm_shuffle_ps(low01, low23, 0xEE));
  _mm_store_ps(at(2), _mm_shuffle_ps(high01, high23, 0x44));
  _mm_store_ps(at(3), _mm_shuffle_ps(high01, high23, 0xEE));
}
template <typename At>
HOOF_INLINE void load_quad(const At& at, VD& a, VD& b, VD& c, VD& d) {
  const __m128d r0 = _mm_load_pd(at(0)), r1 = _mm_load_pd(at(1));
  const __m128d s0 = _mm_load_pd(at(0) + 2), s1 = _mm_load_pd(at(1) + 2);
  a = (VD)_mm_unpacklo_pd(r0, r1), b = (VD)_mm_unpackhi_pd(r0, r1);
  c = (VD)_mm_unpacklo_pd(s0, s1), d = (VD)_mm_unpackhi_pd(s0, s1);
}
template <typename At>
HOOF_INLINE void store_quad(const At& at, VD a, VD b, VD c, VD d) {
  _mm_store_pd(at(0), _mm_unpacklo_pd((__m128d)a, (__m128d)b));
  _mm_store_pd(at(1), _mm_unpackhi_pd((__m128d)a, (__m128d)b));
  _mm_store_pd(at(0) + 2, _mm_unpacklo_pd((__m128d)c, (__m128d)d));
  _mm_store_pd(at(1) + 2, _mm_unpackhi_pd((__m128d)c, (__m128d)d));
}

#endif

}  // namespace HOOF_ISA
}  // namespace hoof::sim
