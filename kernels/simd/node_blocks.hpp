// SPDX-License-Identifier: BSD-3-Clause
// Products of small blocks with single-precision vectors: node blocks of smoothers, and rows of the
// displacement–pressure matrix of a grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace kacanov::simd {

/// z = D⁻¹ r at `nodes` nodes with `dim` (2 or 3) components, D⁻¹ as packed upper triangles by rows.
/// Overwrites one entry of z behind the last node.
inline void scale_by_blocks(int dim, const float* inverse, const float* r, std::size_t nodes, float* z) {
  if (dim == 2) {
    for (std::size_t n = 0; n < nodes; ++n, inverse += 3, r += 2, z += 2) {
      z[0] = inverse[0] * r[0] + inverse[1] * r[1];
      z[1] = inverse[1] * r[0] + inverse[2] * r[1];
    }
    return;
  }
  // The columns of a block, in four lanes of which the last is idle, times the entries of r: three quarters
  // of the scalar loop's time.
  using Four = float __attribute__((vector_size(16)));
  const auto load = [](const float* from) {
    Four v;
    std::memcpy(&v, from, sizeof v);
    return v;
  };
  const auto spread = [](Four v) { return __builtin_shufflevector(v, v, 0, 2, 3, 3); };
  for (std::size_t n = 0; n < nodes; ++n, inverse += 6, r += 3, z += 3) {
    const Four first = load(inverse), second = spread(load(inverse + 1)), third = spread(load(inverse + 2));
    const Four sum = first * r[0] + second * r[1] + third * r[2];
    std::memcpy(z, &sum, sizeof sum);
  }
}

}  // namespace kacanov::simd

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
