// SPDX-License-Identifier: BSD-3-Clause
// A quadrature rule that sees more of an element than the one it is made with.
#pragma once

#include <array>
#include <vector>

#include <kacanov/cells.hpp>

namespace kacanov {

struct QuadraturePoint {
  std::array<double, 3> xi{};  ///< reference coordinates, padded by zeros
  double weight = 0.0;         ///< of the reference cell's volume or area
};

/// Integrates squares of the strains of an element with straight edges exactly, of order twice the element's.
/// An element's own points are where its strains are best: what is wrong with them does not show there.
/// Weights are positive.
std::vector<QuadraturePoint> finer_rule(const Cell& type);

}  // namespace kacanov
