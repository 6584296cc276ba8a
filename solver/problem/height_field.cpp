// SPDX-License-Identifier: BSD-3-Clause
// Heights on a grid, with bilinear interpolation.
#include <kacanov/obstacle.hpp>

#include <algorithm>
#include <cmath>

namespace kacanov {

std::optional<HeightField::Height> HeightField::at(double x, double y) const {
  const std::array<double, 2> place{x, y};
  const std::array<std::size_t, 2> points{columns, rows};
  std::array<std::size_t, 2> cell{};
  std::array<double, 2> share{};
  for (std::size_t c = 0; c < 2; ++c) {
    const double run = (place[c] - lower[c]) / (upper[c] - lower[c]);
    if (!(run >= -1e-9 && run <= 1.0 + 1e-9)) return std::nullopt;
    const double index = std::clamp(run, 0.0, 1.0) * static_cast<double>(points[c] - 1);
    cell[c] = std::min(static_cast<std::size_t>(index), points[c] - 2);
    share[c] = index - static_cast<double>(cell[c]);
  }
  const auto value = [&](std::size_t i, std::size_t j) { return height[columns * (rows - 1 - j) + i]; };
  const auto [i, j] = cell;
  const double low = (1 - share[0]) * value(i, j) + share[0] * value(i + 1, j);
  const double high = (1 - share[0]) * value(i, j + 1) + share[0] * value(i + 1, j + 1);
  const auto [least, most] =
      std::minmax({value(i, j), value(i + 1, j), value(i, j + 1), value(i + 1, j + 1)});
  // The position among n points has a rounding error of some n units.
  const auto widest = static_cast<double>(std::max(rows, columns));
  return Height{(1 - share[1]) * low + share[1] * high,
                1e-15 * (std::max(std::abs(least), std::abs(most)) + widest * (most - least))};
}

}  // namespace kacanov
