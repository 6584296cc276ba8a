// SPDX-License-Identifier: BSD-3-Clause
// What looks mistaken about a problem or its result, though it can be computed.
#pragma once

#include <string>
#include <vector>

#include <kacanov/problem.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// Before it is solved: nothing that acts, units that do not go together, facets that look away from their
/// obstacle or lie inside the body, thin elements, elements that lock. One sentence each, in the words of the
/// case file; `problem` is whole (before keep_boundary) and made of `model`.
std::vector<std::string> examine(const Problem& problem, const Model& model);

/// Of those warnings what may be why a run does not converge; empty where none is.
std::string likely_cause(const std::vector<std::string>& warnings);

/// After: strains, rotations and displacements that are not small, contact that bears nothing. Likewise.
std::vector<std::string> examine(const Result& result, const Model& model);

}  // namespace kacanov
