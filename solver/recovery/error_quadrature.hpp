// SPDX-License-Identifier: BSD-3-Clause
// Quadrature rules that integrate squared differences of strains: finer than those of the stiffness.
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

struct FinePoint {
  double weight = 0.0;
  std::vector<double> gradient;      ///< nodes × dim, along reference coordinates
  std::vector<double> value;         ///< nodes
  std::vector<double> corner_share;  ///< corners: of the straight cell
};

std::vector<FinePoint> fine_points(const Cell& type);

}  // namespace kacanov
