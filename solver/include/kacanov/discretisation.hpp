// SPDX-License-Identifier: BSD-3-Clause
// Estimate of the discretisation error, computed from the solution itself.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/model.hpp>
#include <kacanov/nodal_stress.hpp>
#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>

namespace kacanov {

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
