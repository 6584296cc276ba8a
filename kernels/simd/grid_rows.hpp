// SPDX-License-Identifier: BSD-3-Clause
// Rows of the displacement–pressure matrix of a grid times vectors, the three components of a displacement in
// four lanes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace kacanov::simd {

/// Two registers of the least instruction set there is.
struct FourDoubles {
  using Two = double __attribute__((vector_size(16)));
  Two low, high;

  FourDoubles& operator+=(const FourDoubles& other) {
    low += other.low, high += other.high;
    return *this;
  }
};

inline FourDoubles operator+(FourDoubles a, const FourDoubles& b) { return a += b; }
inline FourDoubles operator*(const FourDoubles& a, double s) { return {a.low * s, a.high * s}; }
inline FourDoubles operator*(const FourDoubles& a, const FourDoubles& b) {
  return {a.low * b.low, a.high * b.high};
}

inline FourDoubles load_four(const double* from) {
  FourDoubles v{};
  std::memcpy(&v.low, from, sizeof v.low);
  std::memcpy(&v.high, from + 2, sizeof v.high);
  return v;
}
inline FourDoubles load_four(const float* from) {
  using Two = float __attribute__((vector_size(8)));
  Two low, high;
  std::memcpy(&low, from, sizeof low);
  std::memcpy(&high, from + 2, sizeof high);
  return {__builtin_convertvector(low, FourDoubles::Two), __builtin_convertvector(high, FourDoubles::Two)};
}
inline void store_four(double* to, const FourDoubles& v) {
  std::memcpy(to, &v.low, sizeof v.low);
  std::memcpy(to + 2, &v.high, sizeof v.high);
}

/// The entries of a row: columns, and what they have in each array of values.
struct GridRow {
  const std::int32_t* column;
  std::size_t begin, end;
};

/// Σ_j M_j x_j of 3 × 3 blocks: `columns` has, an entry, the three columns of M with four values each, the
/// last of them 0; x four values a row.
inline FourDoubles times_blocks(const GridRow& row, const float* columns, const double* x) {
  FourDoubles first{}, second{}, third{};
  for (std::size_t k = row.begin; k < row.end; ++k) {
    const float* m = columns + 12 * k;
    const double* at = x + 4 * static_cast<std::size_t>(row.column[k]);
    first += load_four(m) * at[0], second += load_four(m + 4) * at[1], third += load_four(m + 8) * at[2];
  }
  return first + second + third;
}

/// Σ_j g_j p_j of vectors with four values an entry.
inline FourDoubles times_vectors(const GridRow& row, const float* vectors, const double* p) {
  FourDoubles even{}, odd{};
  std::size_t k = row.begin;
  for (; k + 1 < row.end; k += 2) {
    even += load_four(vectors + 4 * k) * p[row.column[k]];
    odd += load_four(vectors + 4 * k + 4) * p[row.column[k + 1]];
  }
  if (k < row.end) even += load_four(vectors + 4 * k) * p[row.column[k]];
  return even + odd;
}

/// Σ_j d_jᵀ x_j.
inline double dot_vectors(const GridRow& row, const float* vectors, const double* x) {
  FourDoubles even{}, odd{};
  const auto at = [x, &row](std::size_t k) {
    return load_four(x + 4 * static_cast<std::size_t>(row.column[k]));
  };
  std::size_t k = row.begin;
  for (; k + 1 < row.end; k += 2) {
    even += load_four(vectors + 4 * k) * at(k);
    odd += load_four(vectors + 4 * k + 4) * at(k + 1);
  }
  if (k < row.end) even += load_four(vectors + 4 * k) * at(k);
  even += odd;
  const FourDoubles::Two sum = even.low + even.high;
  return sum[0] + sum[1];
}

/// Σ_j c_j p_j.
inline double times_numbers(const GridRow& row, const float* numbers, const double* p) {
  double sum[4] = {};
  const auto term = [&](std::size_t k) { return static_cast<double>(numbers[k]) * p[row.column[k]]; };
  std::size_t k = row.begin;
  for (; k + 3 < row.end; k += 4)
    for (std::size_t i = 0; i < 4; ++i) sum[i] += term(k + i);
  for (; k < row.end; ++k) sum[0] += term(k);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace kacanov::simd
