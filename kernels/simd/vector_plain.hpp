// SPDX-License-Identifier: BSD-3-Clause
// Portable lanes of 16 bytes for any target, with scalar access to records.
#pragma once

#include <cstdint>

#include "simd/inline.hpp"

namespace {

template <class Real>
struct Lanes {
  typedef Real V __attribute__((vector_size(16)));
  static constexpr int width = 16 / static_cast<int>(sizeof(Real));

  KACANOV_INLINE static V load(const Real* p) {
    V v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
  }
  KACANOV_INLINE static void store(Real* p, V v) { __builtin_memcpy(p, &v, sizeof v); }
  KACANOV_INLINE static V widen(const float* p) {
    V v{};
    for (int l = 0; l < width; ++l) v[l] = p[l];
    return v;
  }
  KACANOV_INLINE static void narrow(float* p, V v) {
    for (int l = 0; l < width; ++l) p[l] = static_cast<float>(v[l]);
  }
  KACANOV_INLINE static bool any_above(V v, V limit) {
    bool any = false;
    for (int l = 0; l < width; ++l) any = any || v[l] > limit[l];
    return any;
  }
  KACANOV_INLINE static V sqrt(V v) {
    for (int l = 0; l < width; ++l) v[l] = static_cast<Real>(__builtin_sqrt(v[l]));
    return v;
  }

  // A row is three values of the caller's vector, a record four aligned values of a block.
  struct Record {
    Real at[4];
    Real operator[](int i) const { return at[i]; }
    Record operator+(const Record& o) const {
      return {{at[0] + o[0], at[1] + o[1], at[2] + o[2], at[3] + o[3]}};
    }
  };
  KACANOV_INLINE static Record load_row(const Real* p) { return {{p[0], p[1], p[2], 0}}; }
  KACANOV_INLINE static void store_row(Real* p, Record r) { p[0] = r[0], p[1] = r[1], p[2] = r[2]; }
  KACANOV_INLINE static Record load_record(const Real* p) { return {{p[0], p[1], p[2], p[3]}}; }
  KACANOV_INLINE static void store_record(Real* p, Record r) { __builtin_memcpy(p, r.at, sizeof r); }

  KACANOV_INLINE static void load3(const Real* base, const std::uint16_t* at, V* v) {
    for (int k = 0; k < 3; ++k) {
      Real lane[width];
      for (int l = 0; l < width; ++l) lane[l] = base[at[l] + k];
      v[k] = load(lane);
    }
  }
  /// Loads only the last entries.
  KACANOV_INLINE static V load_last(const Real* base, const std::uint16_t* at) {
    Real lane[width];
    for (int l = 0; l < width; ++l) lane[l] = base[at[l] + 3];
    return load(lane);
  }
  KACANOV_INLINE static void add3(Real* base, const std::uint16_t* at, const V* v) {
    for (int l = 0; l < width; ++l)
      for (int k = 0; k < 3; ++k) base[at[l] + k] += v[k][l];
  }
};

}  // namespace
