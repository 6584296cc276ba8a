// SPDX-License-Identifier: BSD-3-Clause
// Load curves of a model, entry by entry.
#pragma once

#include <string>
#include <vector>

#include <kacanov/problem.hpp>

namespace kacanov {

/// The curves from the time 0, where the entries that some step names have the factor 0; empty without steps.
/// Throws InputError for a name that no entry has, and where all factors of an entry are next to nothing.
std::vector<LoadFactors> load_curves(const Model& model);

/// Factors between the points of the curves; before the first and behind the last, theirs.
LoadFactors factors_at(const std::vector<LoadFactors>& curves, double time);

/// What a boundary entry is multiplied by has the same course as that of another.
bool same_course(const std::vector<LoadFactors>& curves, std::size_t entry, std::size_t other);

}  // namespace kacanov
