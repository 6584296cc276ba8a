// SPDX-License-Identifier: BSD-3-Clause
// AVX2 lanes: 4 doubles or 8 floats, and transposed access to node records.
#pragma once

#include <immintrin.h>

#include <cstdint>

#include "simd/inline.hpp"

namespace {

template <class Real>
struct Lanes;

template <>
struct Lanes<double> {
  typedef double V __attribute__((vector_size(32)));
  static constexpr int width = 4;

  KACANOV_INLINE static V load(const double* p) { return (V)_mm256_loadu_pd(p); }
  KACANOV_INLINE static void store(double* p, V v) { _mm256_storeu_pd(p, (__m256d)v); }
  KACANOV_INLINE static V widen(const float* p) { return (V)_mm256_cvtps_pd(_mm_loadu_ps(p)); }
  KACANOV_INLINE static void narrow(float* p, V v) { _mm_storeu_ps(p, _mm256_cvtpd_ps((__m256d)v)); }
  KACANOV_INLINE static V sqrt(V v) { return (V)_mm256_sqrt_pd((__m256d)v); }
  KACANOV_INLINE static bool any_above(V v, V limit) {
    return _mm256_movemask_pd(_mm256_cmp_pd((__m256d)v, (__m256d)limit, _CMP_GT_OQ)) != 0;
  }

  // A row is three values of the caller's vector, a record four aligned values of a block.
  typedef double Record __attribute__((vector_size(32)));
  KACANOV_INLINE static Record load_row(const double* p) {
    return (Record)_mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p)), _mm_load_sd(p + 2), 1);
  }
  KACANOV_INLINE static void store_row(double* p, Record r) {
    _mm_storeu_pd(p, _mm256_castpd256_pd128((__m256d)r));
    _mm_store_sd(p + 2, _mm256_extractf128_pd((__m256d)r, 1));
  }
  KACANOV_INLINE static Record load_record(const double* p) { return (Record)_mm256_load_pd(p); }
  KACANOV_INLINE static void store_record(double* p, Record r) { _mm256_store_pd(p, (__m256d)r); }

  /// Two half records: insertion from memory costs a load and a blend, no shuffle.
  KACANOV_INLINE static __m256d halves(const double* low, const double* high) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(low)), _mm_load_pd(high), 1);
  }
  KACANOV_INLINE static void load3(const double* base, const std::uint16_t* at, V* v) {
    const double *p0 = base + at[0], *p1 = base + at[1], *p2 = base + at[2], *p3 = base + at[3];
    const __m256d xy02 = halves(p0, p2), xy13 = halves(p1, p3);
    const __m256d z02 = halves(p0 + 2, p2 + 2), z13 = halves(p1 + 2, p3 + 2);
    v[0] = (V)_mm256_unpacklo_pd(xy02, xy13);
    v[1] = (V)_mm256_unpackhi_pd(xy02, xy13);
    v[2] = (V)_mm256_unpacklo_pd(z02, z13);
  }
  /// Loads only the last entries.
  KACANOV_INLINE static V load_last(const double* base, const std::uint16_t* at) {
    const double *p0 = base + at[0], *p1 = base + at[1], *p2 = base + at[2], *p3 = base + at[3];
    return (V)_mm256_unpackhi_pd(halves(p0 + 2, p2 + 2), halves(p1 + 2, p3 + 2));
  }
  KACANOV_INLINE static void add(double* p, __m256d v) {
    _mm256_store_pd(p, _mm256_add_pd(_mm256_load_pd(p), v));
  }
  KACANOV_INLINE static void add3(double* base, const std::uint16_t* at, const V* v) {
    const __m256d x = (__m256d)v[0], y = (__m256d)v[1], z = (__m256d)v[2], zero = _mm256_setzero_pd();
    const __m256d xy0 = _mm256_unpacklo_pd(x, y), xy1 = _mm256_unpackhi_pd(x, y);
    const __m256d z0 = _mm256_unpacklo_pd(z, zero), z1 = _mm256_unpackhi_pd(z, zero);
    add(base + at[0], _mm256_permute2f128_pd(xy0, z0, 0x20));
    add(base + at[1], _mm256_permute2f128_pd(xy1, z1, 0x20));
    add(base + at[2], _mm256_permute2f128_pd(xy0, z0, 0x31));
    add(base + at[3], _mm256_permute2f128_pd(xy1, z1, 0x31));
  }
};

template <>
struct Lanes<float> {
  typedef float V __attribute__((vector_size(32)));
  static constexpr int width = 8;

  KACANOV_INLINE static V load(const float* p) { return (V)_mm256_loadu_ps(p); }
  KACANOV_INLINE static void store(float* p, V v) { _mm256_storeu_ps(p, (__m256)v); }
  KACANOV_INLINE static V widen(const float* p) { return load(p); }
  KACANOV_INLINE static void narrow(float* p, V v) { store(p, v); }
  KACANOV_INLINE static V sqrt(V v) { return (V)_mm256_sqrt_ps((__m256)v); }
  KACANOV_INLINE static bool any_above(V v, V limit) {
    return _mm256_movemask_ps(_mm256_cmp_ps((__m256)v, (__m256)limit, _CMP_GT_OQ)) != 0;
  }

  typedef float Record __attribute__((vector_size(16)));
  KACANOV_INLINE static Record load_row(const float* p) {
    const __m128 xy =
        _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i_u*>(p)));  // aligned like a float
    return (Record)_mm_movelh_ps(xy, _mm_load_ss(p + 2));
  }
  KACANOV_INLINE static void store_row(float* p, Record r) {
    _mm_storel_epi64(reinterpret_cast<__m128i_u*>(p), _mm_castps_si128((__m128)r));
    _mm_store_ss(p + 2, _mm_movehl_ps((__m128)r, (__m128)r));
  }
  KACANOV_INLINE static Record load_record(const float* p) { return (Record)_mm_load_ps(p); }
  KACANOV_INLINE static void store_record(float* p, Record r) { _mm_store_ps(p, (__m128)r); }

  KACANOV_INLINE static __m256 two(const float* base, std::uint16_t low, std::uint16_t high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(base + low)), _mm_load_ps(base + high), 1);
  }
  KACANOV_INLINE static __m256d as_pd(__m256 v) { return _mm256_castps_pd(v); }
  KACANOV_INLINE static void load3(const float* base, const std::uint16_t* at, V* v) {
    const __m256 a = two(base, at[0], at[4]), b = two(base, at[1], at[5]);
    const __m256 c = two(base, at[2], at[6]), d = two(base, at[3], at[7]);
    const __m256d ab = as_pd(_mm256_unpacklo_ps(a, b)), cd = as_pd(_mm256_unpacklo_ps(c, d));
    v[0] = (V)_mm256_unpacklo_pd(ab, cd);
    v[1] = (V)_mm256_unpackhi_pd(ab, cd);
    v[2] = (V)_mm256_unpacklo_pd(as_pd(_mm256_unpackhi_ps(a, b)), as_pd(_mm256_unpackhi_ps(c, d)));
  }
  KACANOV_INLINE static V load_last(const float* base, const std::uint16_t* at) {
    const __m256 a = two(base, at[0], at[4]), b = two(base, at[1], at[5]);
    const __m256 c = two(base, at[2], at[6]), d = two(base, at[3], at[7]);
    return (V)_mm256_unpackhi_pd(as_pd(_mm256_unpackhi_ps(a, b)), as_pd(_mm256_unpackhi_ps(c, d)));
  }
  KACANOV_INLINE static void add(float* p, __m128 v) { _mm_store_ps(p, _mm_add_ps(_mm_load_ps(p), v)); }
  KACANOV_INLINE static void add_two(float* base, const std::uint16_t* at, __m256d v) {
    add(base + at[0], _mm256_castps256_ps128(_mm256_castpd_ps(v)));
    add(base + at[4], _mm256_extractf128_ps(_mm256_castpd_ps(v), 1));
  }
  KACANOV_INLINE static void add3(float* base, const std::uint16_t* at, const V* v) {
    const __m256 x = (__m256)v[0], y = (__m256)v[1], z = (__m256)v[2], zero = _mm256_setzero_ps();
    const __m256d xy0 = as_pd(_mm256_unpacklo_ps(x, y)), xy1 = as_pd(_mm256_unpackhi_ps(x, y));
    const __m256d z0 = as_pd(_mm256_unpacklo_ps(z, zero)), z1 = as_pd(_mm256_unpackhi_ps(z, zero));
    add_two(base, at, _mm256_unpacklo_pd(xy0, z0));
    add_two(base, at + 1, _mm256_unpackhi_pd(xy0, z0));
    add_two(base, at + 2, _mm256_unpacklo_pd(xy1, z1));
    add_two(base, at + 3, _mm256_unpackhi_pd(xy1, z1));
  }
};

}  // namespace
