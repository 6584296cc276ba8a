// SPDX-License-Identifier: BSD-3-Clause
// A point or a direction in 2D or 3D.
#pragma once

#include <array>

namespace kacanov {

using Vector3 = std::array<double, 3>;  ///< in 2D the third entry is 0

}  // namespace kacanov
