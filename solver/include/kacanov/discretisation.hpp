// SPDX-License-Identifier: BSD-3-Clause
// How far a solution is from that of a mesh without end: an estimate from the solution itself.
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

/// theory: error-estimate
struct DiscretisationError {
  /// Of every element: its share of `energy`, in the unit of energy.
  std::vector<double> element;
  double energy = 0.0;    ///< of the error, over all ranks: what the potential energy is above its minimum
  double stored = 0.0;    ///< energy of the solution itself, over all ranks
  double relative = 0.0;  ///< √(energy / stored): in the energy norm, 0.05 for 5 %; 0 without any strain

  /// Of every element: its part of `relative`; squares add up to its square.
  std::vector<double> shares() const;
};

/// By Zienkiewicz and Zhu: strains are compared with polynomials fitted round the corners of the elements.
/// Memory while it works as of recover_stress(). Collective.
DiscretisationError estimate_error(const Part& part, const BodyState& state);

struct Recovered {
  NodalStress nodal;
  DiscretisationError error;
};
/// recover_stress() and estimate_error(), most of whose work is the same: 1.5 times their memory, two thirds
/// of their time. Collective.
Recovered recover_and_estimate(const Part& part, const BodyState& state);

/// The same for a number that is known on meshes of falling width, each half the one before, coarsest first:
/// how far the last is from that of a mesh without end. Nothing of fewer than two numbers.
std::optional<double> error_of_last(std::span<const double> values);

/// Elements (ascending) with a facet of a contact entry that, moved by u, lies in its obstacle by more than
/// `least` somewhere: nodes are kept out of obstacles, what lies between them is not (theory: bisection).
/// Entries whose obstacle moves are passed over.
/// - problem: of `model`, whole; model: with its obstacles' data.
/// - u: nodes × dim of problem.mesh; least: a length.
/// Not collective.
std::vector<std::int32_t> penetrated_elements(const Problem& problem, const Model& model,
                                              std::span<const double> u, double least);

}  // namespace kacanov
