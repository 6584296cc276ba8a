// SPDX-License-Identifier: BSD-3-Clause
// Quadrature rules for squared strain differences.
#include "recovery/error_quadrature.hpp"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace kacanov {
namespace {

/// Three-point Gauss rule along each axis of [−1, 1]^dim.
std::vector<QuadraturePoint> gauss_3(int dim) {
  const double x = std::sqrt(0.6);
  const std::array<double, 3> place{-x, 0.0, x}, weight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  std::vector<QuadraturePoint> rule{{{}, 1.0}};
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dim); ++axis) {
    std::vector<QuadraturePoint> longer;
    for (const QuadraturePoint& point : rule)
      for (std::size_t k = 0; k < 3; ++k) {
        longer.push_back(point);
        longer.back().xi[axis] = place[k];
        longer.back().weight *= weight[k];
      }
    rule = std::move(longer);
  }
  return rule;
}

/// Adds all permutations of the barycentric coordinates (1 − dim a, a, ..., a).
void add_towards_corners(double a, double weight, int dim, std::vector<QuadraturePoint>& rule) {
  for (int corner = 0; corner <= dim; ++corner) {
    QuadraturePoint point{{}, weight};
    for (int i = 0; i < dim; ++i) point.xi[static_cast<std::size_t>(i)] = i + 1 == corner ? 1.0 - dim * a : a;
    rule.push_back(point);
  }
}

/// Adds all permutations of the barycentric coordinates (a, a, ½ − a, ½ − a) of a tetrahedron.
void add_towards_edges(double a, double weight, std::vector<QuadraturePoint>& rule) {
  for (std::size_t first = 0; first < 4; ++first)
    for (std::size_t second = 0; second < first; ++second) {
      std::array<double, 4> all;
      all.fill(0.5 - a);
      all[first] = all[second] = a;
      rule.push_back({{all[1], all[2], all[3]}, weight});
    }
}

}  // namespace

std::vector<QuadraturePoint> error_quadrature(const Cell& type) {
  if (!type.simplex && type.order == 1) return gauss_3(type.dim);
  std::vector<QuadraturePoint> rule;
  if (type.order == 1) {
    // Degree 2.
    const double a = type.dim == 2 ? 1.0 / 6.0 : (5.0 - std::sqrt(5.0)) / 20.0;
    add_towards_corners(a, type.dim == 2 ? 1.0 / 6.0 : 1.0 / 24.0, type.dim, rule);
  } else if (type.dim == 3) {
    // Degree 5 (Walkington 2000).
    add_towards_corners(0.31088591926330060980, 0.018781320953002641800, 3, rule);
    add_towards_corners(0.092735250310891226402, 0.012248840519393658257, 3, rule);
    add_towards_edges(0.045503704125649649492, 0.0070910034628469110730, rule);
  } else {
    throw std::logic_error("no finer rule for " + std::string(type.name));
  }
  return rule;
}

namespace {

/// Returns the cell with straight edges and the same corners.
const Cell& straight(const Cell& type) {
  for (const Cell& other : cells())
    if (other.dim == type.dim && other.corners == type.corners && other.order == 1) return other;
  throw std::logic_error("no straight cell for " + std::string(type.name));
}

}  // namespace

std::vector<ErrorQuadraturePoint> error_quadrature_points(const Cell& type) {
  std::vector<ErrorQuadraturePoint> all;
  for (const QuadraturePoint& point : error_quadrature(type)) {
    ErrorQuadraturePoint one{point.weight,
                             std::vector<double>(static_cast<std::size_t>(type.nodes * type.dim)),
                             std::vector<double>(static_cast<std::size_t>(type.nodes)),
                             std::vector<double>(static_cast<std::size_t>(type.corners))};
    type.gradients(point.xi.data(), one.gradient.data());
    type.values(point.xi.data(), one.value.data());
    straight(type).values(point.xi.data(), one.corner_share.data());
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace kacanov
