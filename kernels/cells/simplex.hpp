// SPDX-License-Identifier: BSD-3-Clause
// Shape functions of simplices from barycentric coordinates, and small types shared by all cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <kacanov/cells.hpp>

namespace kacanov::elements {

using Triple = std::array<std::int8_t, 3>;

/// The identity permutation of the nodes.
template <int nodes>
inline constexpr auto in_order = [] {
  std::array<std::int8_t, nodes> order{};
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::int8_t>(k);
  return order;
}();

/// ∂Lₐ/∂ξ_k of the barycentric coordinates L₀ = 1 − Σ ξ_k, L_k = ξ_{k−1}.
constexpr double barycentric_slope(std::size_t a, std::size_t k) {
  return a == 0 ? -1.0 : a == k + 1 ? 1.0 : 0.0;
}

template <std::size_t dim>
constexpr std::array<double, dim + 1> barycentric(const double* xi) {
  std::array<double, dim + 1> l{1.0};
  for (std::size_t k = 0; k < dim; ++k) l[0] -= xi[k];
  for (std::size_t k = 0; k < dim; ++k) l[k + 1] = xi[k];
  return l;
}

template <std::size_t dim>
constexpr std::array<double, (dim + 1) * dim> barycentric_slopes() {
  std::array<double, (dim + 1) * dim> d{};
  for (std::size_t a = 0; a <= dim; ++a)
    for (std::size_t k = 0; k < dim; ++k) d[a * dim + k] = barycentric_slope(a, k);
  return d;
}

/// Lₐ(2Lₐ − 1) at the corners, 4 LₐL_b at the midpoint of edge ab.
template <class E>
constexpr std::array<double, E::nodes> quadratic_values(const double* xi) {
  const auto l = barycentric<E::dim>(xi);
  std::array<double, E::nodes> n{};
  for (std::size_t a = 0; a < E::corners; ++a) n[a] = l[a] * (2.0 * l[a] - 1.0);
  for (const CellEdge& e : E::edge) n[e.middle] = 4.0 * l[e.a] * l[e.b];
  return n;
}

template <class E>
constexpr std::array<double, E::nodes * E::dim> quadratic_gradients(const double* xi) {
  constexpr std::size_t dim = E::dim;
  const auto l = barycentric<dim>(xi);
  std::array<double, E::nodes * dim> d{};
  for (std::size_t k = 0; k < dim; ++k) {
    for (std::size_t a = 0; a < E::corners; ++a)
      d[dim * a + k] = (4.0 * l[a] - 1.0) * barycentric_slope(a, k);
    for (const CellEdge& e : E::edge) {
      const std::size_t a = e.a, b = e.b;
      d[dim * e.middle + k] = 4.0 * (l[a] * barycentric_slope(b, k) + l[b] * barycentric_slope(a, k));
    }
  }
  return d;
}

/// Corners at the origin and the unit points, then the midpoints of the edges.
template <class E>
constexpr std::array<std::array<double, E::dim>, E::nodes> simplex_nodes() {
  std::array<std::array<double, E::dim>, E::nodes> x{};
  for (std::size_t k = 0; k < E::dim; ++k) x[k + 1][k] = 1.0;
  for (const CellEdge& e : E::edge)
    for (std::size_t k = 0; e.middle >= 0 && k < E::dim; ++k) x[e.middle][k] = 0.5 * (x[e.a][k] + x[e.b][k]);
  return x;
}

}  // namespace kacanov::elements
