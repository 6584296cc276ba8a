// SPDX-License-Identifier: BSD-3-Clause
// Compares totals of a result: forces, moments and contact states of entries, displacements of probes.
#pragma once

#include <string>
#include <vector>

#include "verify/residuals.hpp"

namespace kacanov::verify {

/// A number of the result that differs from the recomputed one.
struct Difference {
  std::string name;
  Real said = 0, found = 0, rounding = 0;
};

/// Compares `contact`, `reaction`, `load`, `probe`, `max_displacement`, `active_nodes` and `slip_nodes` of
/// the result with the recomputed values (theory: verified-totals). Throws Failure if one is missing.
std::vector<Difference> differing_totals(const nlohmann::json& document, const nlohmann::json& result,
                                         const Problem& problem, const Answer& answer,
                                         const BodyResponse& body);

}  // namespace kacanov::verify
