// SPDX-License-Identifier: BSD-3-Clause
// Load curves of a model: the factor of each entry over time.
#pragma once

#include <string>
#include <vector>

#include <kacanov/problem.hpp>

namespace kacanov {

/// Returns the curves from time 0 on, where entries that any step names start at factor 0; empty without
/// steps. Throws InputError for a name that no entry has, and if all factors of an entry are below 1e-15.
std::vector<LoadFactors> load_curves(const Model& model);

/// Returns the factors at `time`, linear between the points of the curves and constant before the first and
/// after the last.
LoadFactors factors_at(const std::vector<LoadFactors>& curves, double time);

/// Whether two boundary entries have the same factors at all points of the curves.
bool same_course(const std::vector<LoadFactors>& curves, std::size_t entry, std::size_t other);

}  // namespace kacanov
