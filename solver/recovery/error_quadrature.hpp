// SPDX-License-Identifier: BSD-3-Clause
// Quadrature rules for squared strain differences, of higher order than those of the stiffness.
#pragma once

#include <array>
#include <vector>

#include <kacanov/cells.hpp>

namespace kacanov {

struct QuadraturePoint {
  std::array<double, 3> xi{};  ///< reference coordinates, padded with zeros
  double weight = 0.0;         ///< share of the reference cell's volume or area
};

/// Returns a rule of twice the element's order with positive weights that integrates squared strains of
/// straight-edged elements exactly. The points of the stiffness are superconvergent, so the error does not
/// show there.
std::vector<QuadraturePoint> error_quadrature(const Cell& type);

struct ErrorQuadraturePoint {
  double weight = 0.0;
  std::vector<double> gradient;      ///< nodes × dim, with respect to reference coordinates
  std::vector<double> value;         ///< nodes
  std::vector<double> corner_share;  ///< shape functions of the straight cell at its corners
};

std::vector<ErrorQuadraturePoint> error_quadrature_points(const Cell& type);

}  // namespace kacanov
