// SPDX-License-Identifier: BSD-3-Clause
// Collects contact fields and totals of the whole body in a result: forces, extremes, counts.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/part.hpp>
#include <kacanov/result.hpp>
#include "contact/admm.hpp"

namespace kacanov {

/// Fills gap, pressure, traction and status of this rank's contact points. A point whose slip exceeds ten
/// times the solve's `tolerance`, relative to the largest displacement, counts as slipping even if |λ_t| is
/// below its bound by rounding. Collective.
void collect_contact(const Part& part, const ContactState& state, double tolerance, Solution& solution);

/// Names the motions of loose pieces that contact leaves free at the end of a load step (theory:
/// loose-modes).
class FreeMotions {
 public:
  /// In the user's units, in which positions are those of the part's pieces. Collective. `place`: of the load
  /// step, in messages; may be empty.
  void look(const Part& part, const ContactState& state, double tolerance, const std::string& place);
  /// One warning per piece, about the first load step at which it was free to move.
  std::vector<std::string> warnings() const;

 private:
  std::vector<double> largest_;     ///< per piece: largest nodal contact force of all load steps so far
  std::vector<std::string> first_;  ///< per piece: the warning; empty: none
};

/// Fills forces, counts, extremes and probes over all ranks from the contact fields and corner_dilatation of
/// `solution`. Collective.
void collect_totals(const Part& part, const ContactState& state, Solution& solution);

/// Fills extremes, plastic and softening elements, and the size of the undeformed body, over all ranks.
/// Collective.
void collect_body_totals(const Part& part, const BodyState& state, Result& result);

}  // namespace kacanov
