// SPDX-License-Identifier: BSD-3-Clause
// The entries of the certificate (theory: kkt, duality-gap, rounding), and the forces, of an answer.
#pragma once

#include "verify/body.hpp"

namespace kacanov::verify {

/// What the result files say the solution is.
struct Answer {
  std::vector<Vec> u;          ///< one a node
  std::vector<Real> pressure;  ///< one a row of the problem: λ_n
  std::vector<Vec> traction;   ///< −λ_t, what the obstacle does to the body
  std::vector<int> status;     ///< 0 open, 1 sticks, 2 slips
};

struct Entry {
  const char* name;
  Real residual = 0, rounding = 0;
};

struct Findings {
  std::vector<Entry> entries;  ///< in the order and with the names of `certificate`
  Vec contact_force{}, friction_force{};
  Real force = 0;     ///< Σ M (|λ_n| + |λ_t|): by which these are measured
  Real pressure = 0;  ///< largest λ_n
  Real supports = 0;  ///< largest |u − prescribed| that rounding does not explain, over the largest |u|
  Real von_mises = 0, unknown_stress = 0;  ///< the largest, and what rounding leaves of one
  BodyResponse body;
};

Findings examine(const Problem& problem, const Answer& answer);

}  // namespace kacanov::verify
