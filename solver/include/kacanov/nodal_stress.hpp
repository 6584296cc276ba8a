// SPDX-License-Identifier: BSD-3-Clause
// Nodal stress, recovered from the quadrature points around each node: it resolves peaks on edges and at
// notches.
#pragma once

#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/part.hpp>
#include <kacanov/totals.hpp>

namespace kacanov {

/// Stress at all local nodes of a part; every copy of a node has the same bits.
struct NodalStress {
  std::vector<double> stress;     ///< nodes × 6: xx yy zz xy yz zx
  std::vector<double> von_mises;  ///< per node, of that stress
  Extreme max_von_mises;          ///< over all ranks
};

/// Superconvergent patch recovery (theory: nodal-stress): at a corner, the value of a polynomial of the
/// element's order fitted to the stresses of the elements around it; at a mid-side node, the mean of the
/// polynomials of the edge's two ends. Each material has its own polynomials; where materials meet, the
/// larger von Mises stress is used. Memory during the call: some 115 numbers per corner for tet10, 40 for
/// other types. Collective.
NodalStress recover_stress(const Part& part, const BodyState& state);

}  // namespace kacanov
