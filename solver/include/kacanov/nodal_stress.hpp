// SPDX-License-Identifier: BSD-3-Clause
// Stress at nodes, recovered from the quadrature points round them: where it peaks, on edges and at notches.
#pragma once

#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/part.hpp>
#include <kacanov/totals.hpp>

namespace kacanov {

/// At all local nodes of a part; the same bits in every copy of a node.
struct NodalStress {
  std::vector<double> stress;     ///< nodes × 6: xx yy zz xy yz zx
  std::vector<double> von_mises;  ///< nodes: of that stress
  Extreme max_von_mises;          ///< over all ranks
};

/// Superconvergent patch recovery (theory: nodal-stress): at a corner the value of a polynomial of the
/// element's order fitted to the stresses of the elements round it, at a middle of an edge the mean of its
/// ends' polynomials. Each material has polynomials of its own; where several meet, the larger von Mises
/// stress is taken. Memory: some 115 numbers a corner of tet10, 40 of others, while it
/// works. Collective.
NodalStress recover_stress(const Part& part, const BodyState& state);

}  // namespace kacanov
