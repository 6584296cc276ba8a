// SPDX-License-Identifier: BSD-3-Clause
// Means of the volume change round the corners of a part's elements.
#pragma once

#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Means of tr ε(u) round the corners of every element, over all ranks: elements × 4, as
/// Body::corner_dilatation has them; empty where no law asks for them. Collective.
std::vector<double> corner_dilatation(const Part& part, std::span<const double> u);

}  // namespace kacanov
