// SPDX-License-Identifier: BSD-3-Clause
// The size of a body over all ranks.
#pragma once

#include <kacanov/part.hpp>

namespace kacanov {

/// Longest side of the body's bounding box, over all ranks. Collective.
double body_extent(const Part& part);

}  // namespace kacanov
