// SPDX-License-Identifier: BSD-3-Clause
// Products of rows of the displacement–pressure matrix of a grid with single-precision vectors; a row takes
// four lanes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace kacanov::simd {

using FourFloats = float __attribute__((vector_size(16)));

inline FourFloats load_four(const float* from) {
  FourFloats v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline void store_four(float* to, const FourFloats& v) { std::memcpy(to, &v, sizeof v); }

/// M x for a matrix M of three columns with four values each.
inline FourFloats times_three(const float* columns, const float* x) {
  return load_four(columns) * x[0] + load_four(columns + 4) * x[1] + load_four(columns + 8) * x[2];
}

/// The entries of a row: their columns, and their range in the arrays of values.
struct GridRow {
  const std::int32_t* column;
  std::size_t begin, end;
};

/// Σ_j M_j x_j for the first three of x's four values per node. `columns`: per entry the three columns of M
/// with four values each.
inline FourFloats times_blocks(const GridRow& row, const float* columns, const float* x) {
  FourFloats first{}, second{}, third{};
  for (std::size_t k = row.begin; k < row.end; ++k) {
    const float* m = columns + 12 * k;
    const float* at = x + 4 * static_cast<std::size_t>(row.column[k]);
    first += load_four(m) * at[0], second += load_four(m + 4) * at[1], third += load_four(m + 8) * at[2];
  }
  return first + second + third;
}

/// Σ_j g_j p_j for vectors with four values per entry; p has `stride` values per node and the first is used.
template <std::size_t stride = 1>
FourFloats times_vectors(const GridRow& row, const float* vectors, const float* p) {
  FourFloats even{}, odd{};
  const auto term = [&](std::size_t k) {
    return load_four(vectors + 4 * k) * p[stride * static_cast<std::size_t>(row.column[k])];
  };
  std::size_t k = row.begin;
  for (; k + 1 < row.end; k += 2) even += term(k), odd += term(k + 1);
  if (k < row.end) even += term(k);
  return even + odd;
}

/// Σ_j d_jᵀ x_j.
inline float dot_vectors(const GridRow& row, const float* vectors, const float* x) {
  FourFloats even{}, odd{};
  const auto term = [&](std::size_t k) {
    return load_four(vectors + 4 * k) * load_four(x + 4 * static_cast<std::size_t>(row.column[k]));
  };
  std::size_t k = row.begin;
  for (; k + 1 < row.end; k += 2) even += term(k), odd += term(k + 1);
  if (k < row.end) even += term(k);
  even += odd;
  return (even[0] + even[1]) + (even[2] + even[3]);
}

/// Σ_j c_j p_j, with four partial sums.
inline float times_numbers(const GridRow& row, const float* numbers, const float* p) {
  FourFloats sum{};
  std::size_t k = row.begin;
  for (; k + 3 < row.end; k += 4) {
    const std::int32_t* c = row.column + k;
    sum += load_four(numbers + k) * FourFloats{p[c[0]], p[c[1]], p[c[2]], p[c[3]]};
  }
  for (; k < row.end; ++k) sum[0] += numbers[k] * p[row.column[k]];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}
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
