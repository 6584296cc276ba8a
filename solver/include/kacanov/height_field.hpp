// SPDX-License-Identifier: BSD-3-Clause
// Heights on a grid, with bilinear interpolation.
#pragma once

#include <optional>
#include <vector>

#include <kacanov/obstacle.hpp>

namespace kacanov {

/// `rows` × `columns` heights, at least 2 × 2; the first row has the largest y, as in a picture. The corner
/// values lie at the corners of [lower, upper].
struct HeightField {
  std::size_t rows = 0, columns = 0;
  std::vector<double> height;
  std::array<double, 2> lower{}, upper{};

  struct Height {
    double value = 0.0;
    double unknown = 0.0;  ///< bound on its rounding error
  };
  /// Returns the interpolated height; empty outside the grid, with a tolerance of 1e-9 of its size.
  std::optional<Height> at(double x, double y) const;
};

}  // namespace kacanov
