// SPDX-License-Identifier: BSD-3-Clause
// Which way a point faces an obstacle that is equally near in several directions (theory: equal-distance).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <kacanov/obstacle.hpp>

namespace kacanov {

/// The direction that is taken, as places in the list of candidates.
struct FaceChoice {
  std::vector<std::size_t> chosen;  ///< one direction, or several whose mean it is
  bool decides = false;             ///< another choice would have faced the body as well
};

/// Of unit directions from a point towards its equally near faces: the one along the body's outer normal
/// most; of those that are as much so all, to be averaged, or where they cancel the last in the order of
/// their components.
FaceChoice choose_face(std::span<const Vector3> directions, const Vector3& outer);

}  // namespace kacanov
