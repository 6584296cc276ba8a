// SPDX-License-Identifier: BSD-3-Clause
// Numbers on a grid, as a height map has them.
#pragma once

#include <cstdint>
#include <vector>

namespace kacanov {

/// The first row is the upper one of a picture.
struct NumberGrid {
  static constexpr std::int64_t most_values = std::int64_t{1} << 28;

  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
};

}  // namespace kacanov
