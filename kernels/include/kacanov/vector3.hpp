// SPDX-License-Identifier: BSD-3-Clause
// A point or a direction, of whatever dimension the body has.
#pragma once

#include <array>

namespace kacanov {

using Vector3 = std::array<double, 3>;  ///< in 2D the third entry is 0

}  // namespace kacanov
