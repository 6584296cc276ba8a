// SPDX-License-Identifier: BSD-3-Clause
// Mean volume change around the corners of a part's elements.
#pragma once

#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Returns the means of tr ε(u) around the corners of every element, taken over all ranks: elements × 4, as
/// in Body::corner_dilatation; empty if no law needs them. Collective.
std::vector<double> corner_dilatation(const Part& part, std::span<const double> u);

}  // namespace kacanov
