// SPDX-License-Identifier: BSD-3-Clause
// AVX-512 lanes: 8 doubles or 16 floats, and transposed access to node records.
#pragma once

#include <immintrin.h>

#include <cstdint>

#include "simd/inline.hpp"

namespace {

template <class Real>
struct Lanes;

// Records are read by plain loads with a masked broadcast into the upper half, which costs a blend and no
// shuffle; gather instructions took twice the time (Zen 4). Two records share a register so that the lanes
// are in order.
template <>
struct Lanes<double> {
  typedef double V __attribute__((vector_size(64)));
  static constexpr int width = 8;

  KACANOV_INLINE static V load(const double* p) { return (V)_mm512_loadu_pd(p); }
  KACANOV_INLINE static void store(double* p, V v) { _mm512_storeu_pd(p, (__m512d)v); }
  KACANOV_INLINE static V widen(const float* p) { return (V)_mm512_cvtps_pd(_mm256_loadu_ps(p)); }
  KACANOV_INLINE static void narrow(float* p, V v) { _mm256_storeu_ps(p, _mm512_cvtpd_ps((__m512d)v)); }
  KACANOV_INLINE static V sqrt(V v) { return (V)_mm512_sqrt_pd((__m512d)v); }
  KACANOV_INLINE static bool any_above(V v, V limit) {
    return _mm512_cmp_pd_mask((__m512d)v, (__m512d)limit, _CMP_GT_OQ) != 0;
  }

  // A row is three values of the caller's vector, a record four aligned values of a block.
  typedef double Record __attribute__((vector_size(32)));
  KACANOV_INLINE static Record load_row(const double* p) { return (Record)_mm256_maskz_loadu_pd(7, p); }
  KACANOV_INLINE static void store_row(double* p, Record r) { _mm256_mask_storeu_pd(p, 7, (__m256d)r); }
  KACANOV_INLINE static Record load_record(const double* p) { return (Record)_mm256_load_pd(p); }
  KACANOV_INLINE static void store_record(double* p, Record r) { _mm256_store_pd(p, (__m256d)r); }

  KACANOV_INLINE static __m512d pair(const double* base, std::uint16_t low, std::uint16_t high) {
    return _mm512_mask_broadcast_f64x4(_mm512_castpd256_pd512(_mm256_load_pd(base + low)), 0xF0,
                                       _mm256_load_pd(base + high));
  }
  KACANOV_INLINE static void load3(const double* base, const std::uint16_t* at, V* v) {
    const __m512d a = pair(base, at[0], at[2]), b = pair(base, at[1], at[3]);
    const __m512d c = pair(base, at[4], at[6]), d = pair(base, at[5], at[7]);
    const __m512d ab = _mm512_unpacklo_pd(a, b), cd = _mm512_unpacklo_pd(c, d);
    v[0] = (V)_mm512_shuffle_f64x2(ab, cd, 0x88);
    v[2] = (V)_mm512_shuffle_f64x2(ab, cd, 0xDD);
    v[1] = (V)_mm512_shuffle_f64x2(_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d), 0x88);
  }
  /// Loads only the last entries.
  KACANOV_INLINE static V load_last(const double* base, const std::uint16_t* at) {
    const __m512d a = pair(base, at[0], at[2]), b = pair(base, at[1], at[3]);
    const __m512d c = pair(base, at[4], at[6]), d = pair(base, at[5], at[7]);
    return (V)_mm512_shuffle_f64x2(_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d), 0xDD);
  }
  KACANOV_INLINE static void add(double* p, __m256d v) {
    _mm256_store_pd(p, _mm256_add_pd(_mm256_load_pd(p), v));
  }
  KACANOV_INLINE static void add3(double* base, const std::uint16_t* at, const V* v) {
    const __m512d x = (__m512d)v[0], y = (__m512d)v[1], z = (__m512d)v[2], zero = _mm512_setzero_pd();
    const __m512d xy0 = _mm512_unpacklo_pd(x, y), xy1 = _mm512_unpackhi_pd(x, y);
    const __m512d z0 = _mm512_unpacklo_pd(z, zero), z1 = _mm512_unpackhi_pd(z, zero);
    const __m512i low = _mm512_set_epi64(11, 10, 3, 2, 9, 8, 1, 0);
    const __m512i high = _mm512_set_epi64(15, 14, 7, 6, 13, 12, 5, 4);
    const __m512d r02 = _mm512_permutex2var_pd(xy0, low, z0), r46 = _mm512_permutex2var_pd(xy0, high, z0);
    const __m512d r13 = _mm512_permutex2var_pd(xy1, low, z1), r57 = _mm512_permutex2var_pd(xy1, high, z1);
    add(base + at[0], _mm512_castpd512_pd256(r02));
    add(base + at[1], _mm512_castpd512_pd256(r13));
    add(base + at[2], _mm512_extractf64x4_pd(r02, 1));
    add(base + at[3], _mm512_extractf64x4_pd(r13, 1));
    add(base + at[4], _mm512_castpd512_pd256(r46));
    add(base + at[5], _mm512_castpd512_pd256(r57));
    add(base + at[6], _mm512_extractf64x4_pd(r46, 1));
    add(base + at[7], _mm512_extractf64x4_pd(r57, 1));
  }
};

template <>
struct Lanes<float> {
  typedef float V __attribute__((vector_size(64)));
  static constexpr int width = 16;

  KACANOV_INLINE static V load(const float* p) { return (V)_mm512_loadu_ps(p); }
  KACANOV_INLINE static void store(float* p, V v) { _mm512_storeu_ps(p, (__m512)v); }
  KACANOV_INLINE static V widen(const float* p) { return load(p); }
  KACANOV_INLINE static void narrow(float* p, V v) { store(p, v); }
  KACANOV_INLINE static V sqrt(V v) { return (V)_mm512_sqrt_ps((__m512)v); }
  KACANOV_INLINE static bool any_above(V v, V limit) {
    return _mm512_cmp_ps_mask((__m512)v, (__m512)limit, _CMP_GT_OQ) != 0;
  }

  typedef float Record __attribute__((vector_size(16)));
  KACANOV_INLINE static Record load_row(const float* p) { return (Record)_mm_maskz_loadu_ps(7, p); }
  KACANOV_INLINE static void store_row(float* p, Record r) { _mm_mask_storeu_ps(p, 7, (__m128)r); }
  KACANOV_INLINE static Record load_record(const float* p) { return (Record)_mm_load_ps(p); }
  KACANOV_INLINE static void store_record(float* p, Record r) { _mm_store_ps(p, (__m128)r); }

  /// Lanes k, k+4, k+8, k+12 of a batch, so that the in-lane transposition leaves them in order.
  KACANOV_INLINE static __m512 four(const float* base, const std::uint16_t* at) {
    __m512 r = _mm512_castps128_ps512(_mm_load_ps(base + at[0]));
    r = _mm512_mask_broadcast_f32x4(r, 0x00F0, _mm_load_ps(base + at[4]));
    r = _mm512_mask_broadcast_f32x4(r, 0x0F00, _mm_load_ps(base + at[8]));
    return _mm512_mask_broadcast_f32x4(r, 0xF000, _mm_load_ps(base + at[12]));
  }
  KACANOV_INLINE static __m512d as_pd(__m512 v) { return _mm512_castps_pd(v); }
  KACANOV_INLINE static void load3(const float* base, const std::uint16_t* at, V* v) {
    const __m512 a = four(base, at), b = four(base, at + 1), c = four(base, at + 2), d = four(base, at + 3);
    const __m512 ab = _mm512_unpacklo_ps(a, b), cd = _mm512_unpacklo_ps(c, d);
    v[0] = (V)_mm512_unpacklo_pd(as_pd(ab), as_pd(cd));
    v[1] = (V)_mm512_unpackhi_pd(as_pd(ab), as_pd(cd));
    v[2] = (V)_mm512_unpacklo_pd(as_pd(_mm512_unpackhi_ps(a, b)), as_pd(_mm512_unpackhi_ps(c, d)));
  }
  KACANOV_INLINE static V load_last(const float* base, const std::uint16_t* at) {
    const __m512 a = four(base, at), b = four(base, at + 1), c = four(base, at + 2), d = four(base, at + 3);
    return (V)_mm512_unpackhi_pd(as_pd(_mm512_unpackhi_ps(a, b)), as_pd(_mm512_unpackhi_ps(c, d)));
  }
  KACANOV_INLINE static void add(float* p, __m128 v) { _mm_store_ps(p, _mm_add_ps(_mm_load_ps(p), v)); }
  KACANOV_INLINE static void add_four(float* base, const std::uint16_t* at, __m512 v) {
    add(base + at[0], _mm512_castps512_ps128(v));
    add(base + at[4], _mm512_extractf32x4_ps(v, 1));
    add(base + at[8], _mm512_extractf32x4_ps(v, 2));
    add(base + at[12], _mm512_extractf32x4_ps(v, 3));
  }
  KACANOV_INLINE static void add3(float* base, const std::uint16_t* at, const V* v) {
    const __m512 x = (__m512)v[0], y = (__m512)v[1], z = (__m512)v[2], zero = _mm512_setzero_ps();
    const __m512d xy0 = as_pd(_mm512_unpacklo_ps(x, y)), xy1 = as_pd(_mm512_unpackhi_ps(x, y));
    const __m512d z0 = as_pd(_mm512_unpacklo_ps(z, zero)), z1 = as_pd(_mm512_unpackhi_ps(z, zero));
    add_four(base, at, (__m512)_mm512_unpacklo_pd(xy0, z0));
    add_four(base, at + 1, (__m512)_mm512_unpackhi_pd(xy0, z0));
    add_four(base, at + 2, (__m512)_mm512_unpacklo_pd(xy1, z1));
    add_four(base, at + 3, (__m512)_mm512_unpackhi_pd(xy1, z1));
  }
};

}  // namespace
