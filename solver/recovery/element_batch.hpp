// SPDX-License-Identifier: BSD-3-Clause
// Loops over elements that compute strains and stresses at points, one element or one SIMD batch at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <kacanov/reference.hpp>
#include "reference/point_strain.hpp"
#include "simd/row_points.hpp"

namespace kacanov {

constexpr std::size_t batch_size = simd::row_lanes;
/// One number per element of a batch. Loops over lanes have no branches and no calls, so that compilers
/// vectorise them.
using Lanes = simd::RowLanes;
using ElementBatch = std::array<std::size_t, batch_size>;

/// Returns the indices of a batch that starts at `first`; the last element is repeated at the end.
inline ElementBatch in_a_row(std::size_t first, std::size_t elements) {
  ElementBatch row;
  for (std::size_t lane = 0; lane < batch_size; ++lane) row[lane] = std::min(first + lane, elements - 1);
  return row;
}

/// Gathers nodal vectors for elements with this number of nodes, in 3D.
template <std::size_t nodes>
void gather(const MeshView& mesh, const ElementBatch& element, std::span<const double> values,
            Lanes (&out)[nodes][3]) {
  for (std::size_t lane = 0; lane < batch_size; ++lane) {
    const std::int32_t* node = &mesh.connectivity[nodes * element[lane]];
    for (std::size_t a = 0; a < nodes; ++a) {
      const std::size_t from = 3 * static_cast<std::size_t>(node[a]);
      for (std::size_t i = 0; i < 3; ++i) out[a][i][lane] = values[from + i];
    }
  }
}

/// Computes ∂u_i/∂x_k from j = ∂x/∂ξ and d = ∂u/∂ξ; returns det j.
inline double map_gradient(const double (&j)[3][3], const double (&d)[3][3], double (&gradient)[3][3]) {
  double cofactor[3][3];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      cofactor[i][k] = j[i1][k1] * j[i2][k2] - j[i1][k2] * j[i2][k1];
    }
  const double det = j[0][0] * cofactor[0][0] + j[0][1] * cofactor[0][1] + j[0][2] * cofactor[0][2];
  const double scale = 1.0 / det;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      gradient[i][k] =
          scale * (d[i][0] * cofactor[k][0] + d[i][1] * cofactor[k][1] + d[i][2] * cofactor[k][2]);
  return det;
}

inline reference::Gradient gradient_of(const Lanes (&gradient)[3][3], std::size_t lane) {
  reference::Gradient h;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) h[i][k] = gradient[i][k][lane];
  return h;
}

/// Same as the functions of these names in reference, up to rounding.
struct FieldLoops {
  void (*fields)(const Body& body, std::span<const double> u, const reference::ElementFields& out);
  void (*point_fields)(const Body& body, std::span<const double> u, const reference::PointFields& out);
  double (*energy)(const Body& body, std::span<const double> u);
  void (*volumes)(const Body& body, std::span<double> volume);
};

/// Loops in batches of elements; Body::moduli must be null.
extern const FieldLoops tet4_loops, hex8_loops, tet10_loops;

/// Returns the fastest loops: those of the reference for types without batched ones.
const FieldLoops& field_loops(ElementType type);

}  // namespace kacanov
