// SPDX-License-Identifier: BSD-3-Clause
// Superconvergent patch recovery: stress at the nodes, and the estimate of the discretisation error.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/model.hpp>
#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>
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

/// Estimated error of a solution (theory: error-estimate).
struct DiscretisationError {
  /// Share of `energy` per element, in units of energy.
  std::vector<double> element;
  double energy = 0.0;    ///< of the error, over all ranks: the potential energy above its minimum
  double stored = 0.0;    ///< energy of the solution itself, over all ranks
  double relative = 0.0;  ///< √(energy / stored), in the energy norm: 0.05 is 5 %; 0 without strain

  /// Share of `relative` per element; the sum of squares is the square of `relative`.
  std::vector<double> shares() const;
};

/// Zienkiewicz–Zhu estimate: compares the strains with polynomials fitted around the corners of the elements.
/// Memory during the call as for recover_stress(). Collective.
DiscretisationError estimate_error(const Part& part, const BodyState& state);

struct Recovered {
  NodalStress nodal;
  DiscretisationError error;
};
/// recover_stress() and estimate_error(), which share most of their work: 1.5 times the memory and two thirds
/// of the time of separate calls. Collective.
Recovered recover_and_estimate(const Part& part, const BodyState& state);

/// Extrapolates a value computed on a sequence of meshes, coarsest first, each with half the mesh width of
/// the one before: returns the estimated distance of the last value from its limit. Empty for fewer than two
/// values.
std::optional<double> error_of_last(std::span<const double> values);

/// Returns, ascending, the elements with a facet of a contact entry of which, displaced by u, some point
/// penetrates the obstacle by more than `least`: contact constrains only nodes, not the points between them
/// (theory: bisection). Ignores entries whose obstacle moves.
/// - problem: the complete problem, built from `model`; model: with its obstacles' data.
/// - u: nodes × dim of problem.mesh; least: a length.
/// Not collective.
std::vector<std::int32_t> penetrated_elements(const Problem& problem, const Model& model,
                                              std::span<const double> u, double least);

}  // namespace kacanov
