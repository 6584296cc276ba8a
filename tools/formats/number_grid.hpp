// SPDX-License-Identifier: BSD-3-Clause
// A grid of numbers, such as a height map.
#pragma once

#include <cstdint>
#include <vector>

namespace kacanov {

/// Row-major; the first row is the top row of a picture.
struct NumberGrid {
  static constexpr std::int64_t most_values = std::int64_t{1} << 28;

  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
};

}  // namespace kacanov
