// SPDX-License-Identifier: BSD-3-Clause
// Recomputes the certificate (theory: kkt, duality-gap, rounding) and the contact forces of a solution.
#pragma once

#include "verify/body.hpp"

namespace kacanov::verify {

/// Solution as read from the result files.
struct Answer {
  std::vector<Vec> u;          ///< one per node
  std::vector<Real> pressure;  ///< one per row of the problem: λ_n
  std::vector<Vec> traction;   ///< −λ_t, the traction on the body
  std::vector<int> status;     ///< 0 open, 1 sticks, 2 slips
};

struct Entry {
  const char* name;
  Real residual = 0, rounding = 0;
};

struct Findings {
  std::vector<Entry> entries;  ///< in the order and with the names of `certificate`
  Vec contact_force{}, friction_force{};
  Real force = 0;     ///< Σ M (|λ_n| + |λ_t|): reference for force errors
  Real pressure = 0;  ///< largest λ_n
  Real supports = 0;  ///< largest |u − prescribed| beyond round-off, divided by the largest |u|
  Real von_mises = 0, unknown_stress = 0;  ///< largest value, and round-off of a stress
  BodyResponse body;
};

Findings examine(const Problem& problem, const Answer& answer);

}  // namespace kacanov::verify
