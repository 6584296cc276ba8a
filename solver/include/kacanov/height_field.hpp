// SPDX-License-Identifier: BSD-3-Clause
// Heights on a grid, bilinear in between.
#pragma once

#include <optional>
#include <vector>

#include <kacanov/obstacle.hpp>

namespace kacanov {

/// `rows` × `columns` heights, at least 2 × 2, the first row along the largest y as in a picture; the corner
/// values lie in the corners of [lower, upper].
struct HeightField {
  std::size_t rows = 0, columns = 0;
  std::vector<double> height;
  std::array<double, 2> lower{}, upper{};

  struct Height {
    double value = 0.0;
    double unknown = 0.0;  ///< what arithmetic may have left of it
  };
  /// Nothing beyond the grid, which 1e-9 of its size still belongs to.
  std::optional<Height> at(double x, double y) const;
};

}  // namespace kacanov
