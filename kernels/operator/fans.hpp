// SPDX-License-Identifier: BSD-3-Clause
// The greedy cover of a tetrahedral mesh by fans.
#pragma once

#include "operator/units.hpp"

namespace kacanov {

/// Each element that is not in `left_out` is in exactly one fan; the elements of a fan share one law.
Units cover_by_fans(const Body& body, std::vector<bool> left_out);

}  // namespace kacanov
