// SPDX-License-Identifier: BSD-3-Clause
// Warnings about a problem or its result that can be computed but look mistaken.
#pragma once

#include <string>
#include <vector>

#include <kacanov/problem.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// Returns warnings before the solve: nothing acts on the body, inconsistent units, facets that face away
/// from their obstacle or lie inside the body, thin elements, elements that lock. One sentence each, in the
/// terms of the case file; `problem` is complete (before keep_boundary()) and built from `model`.
std::vector<std::string> examine(const Problem& problem, const Model& model);

/// Returns those of the warnings that may explain why a run does not converge; empty if there are none.
std::string likely_cause(const std::vector<std::string>& warnings);

/// Returns warnings after the solve, in the same form: large strains, rotations or displacements, contact
/// that carries no load.
std::vector<std::string> examine(const Result& result, const Model& model);

}  // namespace kacanov
