// SPDX-License-Identifier: BSD-3-Clause
// Shape functions and Gauss points of lines, quadrilaterals and hexahedra as tensor products of linear ones.
#pragma once

#include "cells/simplex.hpp"

namespace kacanov::elements {

inline constexpr double gauss2 = 0.57735026918962576;  ///< 1/√3

/// Π (1 + c_k ξ_k)/2 with the coordinates c of each corner.
template <class E>
constexpr std::array<double, E::nodes> tensor_values(const double* xi) {
  std::array<double, E::nodes> n{};
  for (std::size_t a = 0; a < E::nodes; ++a) {
    n[a] = 1.0 / E::nodes;
    for (std::size_t k = 0; k < E::dim; ++k) n[a] *= 1 + E::corner[a][k] * xi[k];
  }
  return n;
}

template <class E>
constexpr std::array<double, E::nodes * E::dim> tensor_gradients(const double* xi) {
  std::array<double, E::nodes * E::dim> d{};
  for (std::size_t a = 0; a < E::nodes; ++a)
    for (std::size_t k = 0; k < E::dim; ++k) {
      double slope = 1.0 / E::nodes * E::corner[a][k];
      for (std::size_t l = 0; l < E::dim; ++l)
        if (l != k) slope *= 1 + E::corner[a][l] * xi[l];
      d[E::dim * a + k] = slope;
    }
  return d;
}

/// The corners, scaled towards the centre by `factor`.
template <class E>
constexpr std::array<std::array<double, E::dim>, E::nodes> tensor_points(double factor) {
  std::array<std::array<double, E::dim>, E::nodes> p{};
  for (std::size_t a = 0; a < E::nodes; ++a)
    for (std::size_t k = 0; k < E::dim; ++k) p[a][k] = factor * E::corner[a][k];
  return p;
}

/// The unit cell as one element.
template <class E>
constexpr std::array<Triple, E::nodes> whole_box() {
  std::array<Triple, E::nodes> at{};
  for (std::size_t a = 0; a < E::nodes; ++a)
    for (std::size_t k = 0; k < E::dim; ++k) at[a][k] = E::corner[a][k] > 0 ? 1 : 0;
  return at;
}

}  // namespace kacanov::elements
