// SPDX-License-Identifier: BSD-3-Clause
// One quadrature point of an element in space: shape function gradients and volume.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

#include <kacanov/mesh_view.hpp>

namespace kacanov::elements {

/// Nodal values of one element, nodes × dim.
template <class E>
using Nodal = std::array<double, E::nodes * E::dim>;

template <class E>
Nodal<E> coordinates_of(const MeshView& mesh, std::size_t element) {
  Nodal<E> x;
  for (std::size_t a = 0; a < E::nodes; ++a) {
    const std::size_t from = E::dim * static_cast<std::size_t>(mesh.connectivity[element * E::nodes + a]);
    for (std::size_t k = 0; k < E::dim; ++k) x[E::dim * a + k] = mesh.coordinates[from + k];
  }
  return x;
}

template <class E>
struct Point {
  double gradient[E::nodes][E::dim];
  double dilatation[E::nodes][E::dim];  ///< the same of the tr ε that k0 acts on: element averages with B-bar
  double hoop[E::nodes];                ///< N/r in an axisymmetric body, ε_zz per u_x; 0 in others
  double volume;                        ///< volume of the point; not positive where the element is inverted

  Point() = default;
  /// theory: axisymmetry
  explicit Point(const Nodal<E>& x, std::size_t q, PlaneState plane = PlaneState::strain) {
    constexpr bool simplex = E::nodes == E::dim + 1;  // node 0 at ξ = 0, node k + 1 at ξ_k = 1
    [[maybe_unused]] const auto d = E::gradients(E::point[q].data());
    double j[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // j[i][k] = ∂x_i/∂ξ_k
    for (int i = 0; i < E::dim; ++i)
      for (int k = 0; k < E::dim; ++k) {
        if constexpr (simplex) {
          j[i][k] = x[at(k + 1, i)] - x[at(0, i)];
        } else {
          j[i][k] = 0.0;
          // Differences of coordinates keep their digits if the body lies far from the origin (theory:
          // elements).
          for (int a = 1; a < E::nodes; ++a) j[i][k] += (x[at(a, i)] - x[at(0, i)]) * d[at(a, k)];
        }
      }
    double cofactor[3][3];  // inverse = transposed cofactor / det
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        cofactor[i][k] = j[i1][k1] * j[i2][k2] - j[i1][k2] * j[i2][k1];
      }
    const double det = j[0][0] * cofactor[0][0] + j[0][1] * cofactor[0][1] + j[0][2] * cofactor[0][2];
    const double scale = 1.0 / det;
    volume = det * E::weight;
    for (int i = 0; i < E::dim; ++i) {
      for (int k = 0; k < 3; ++k) cofactor[i][k] *= scale;
      if constexpr (simplex) {
        gradient[0][i] = 0.0;
        for (int k = 0; k < E::dim; ++k) {
          gradient[k + 1][i] = cofactor[i][k];
          gradient[0][i] -= cofactor[i][k];
        }
      } else {
        for (int a = 0; a < E::nodes; ++a) {
          gradient[a][i] = 0.0;
          for (int k = 0; k < E::dim; ++k) gradient[a][i] += cofactor[i][k] * d[at(a, k)];
        }
      }
      for (int a = 0; a < E::nodes; ++a) dilatation[a][i] = gradient[a][i];
    }
    for (double& value : hoop) value = 0.0;
    if constexpr (E::dim == 2)
      if (plane == PlaneState::axisymmetric) turn_round(x, q);
  }

  /// tr ε at the point for a unit displacement of node a along i.
  double trace(int a, int i) const { return gradient[a][i] + (i == 0 ? hoop[a] : 0.0); }

  /// Adds the dim × dim diagonal block of node a in B: volume [k0 ∇ᵢ∇ⱼ + g (∇ᵢ∇ⱼ/3 + |∇|² δᵢⱼ)], with the
  /// terms of the hoop strain.
  template <class Real>
  void add_diagonal_block(int a, double bulk, double g, Real* block) const {
    const double *d = gradient[a], *mean = dilatation[a], k = volume * bulk, s = volume * g,
                 third = s * (1.0 / 3.0);
    double square = 0.0;
    for (int i = 0; i < E::dim; ++i) square += d[i] * d[i];
    for (int i = 0; i < E::dim; ++i)
      for (int j = 0; j < E::dim; ++j)
        block[i * E::dim + j] +=
            static_cast<Real>(k * mean[i] * mean[j] + third * d[i] * d[j] + (i == j ? s * square : 0.0));
    if constexpr (E::dim == 2) {  // adds the terms with h = N/r of 2 g ε:ε − 2/3 g (tr ε)²
      const double h = hoop[a];
      block[0] += static_cast<Real>(s * h * (4.0 / 3.0 * h - 4.0 / 3.0 * d[0]));
      block[1] -= static_cast<Real>(2.0 * third * h * d[1]);
      block[2] -= static_cast<Real>(2.0 * third * h * d[1]);
    }
  }

  /// Adds the diagonal block of node a in the tangent's rank-one term `factor` d ⊗ d: volume factor
  /// (d∇)(d∇)ᵀ. `d` is symmetric and traceless: xx yy zz xy yz zx.
  template <class Real>
  void add_rank_one_block(int a, double factor, const std::array<double, 6>& d, Real* block) const {
    constexpr int entry[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    double along[E::dim] = {};
    for (int i = 0; i < E::dim; ++i)
      for (int k = 0; k < E::dim; ++k) along[i] += d[entry[i][k]] * gradient[a][k];
    along[0] += d[2] * hoop[a];
    for (int i = 0; i < E::dim; ++i)
      for (int j = 0; j < E::dim; ++j)
        block[i * E::dim + j] += static_cast<Real>(volume * factor * along[i] * along[j]);
  }

  static constexpr std::size_t at(int a, int i) { return a * E::dim + i; }

 private:
  void turn_round(const Nodal<E>& x, std::size_t q) {
    const auto shape = E::values(E::point[q].data());
    double r = 0.0;
    for (int a = 0; a < E::nodes; ++a) r += shape[a] * x[at(a, 0)];
    volume *= 2.0 * std::numbers::pi * r;
    for (int a = 0; a < E::nodes; ++a) {
      hoop[a] = shape[a] / r;
      dilatation[a][0] += hoop[a];
    }
  }
};

/// All points of an element. With `mean_dilatation` (the selective B-bar method of Hughes, 1980) tr ε is its
/// average over the element, so that k0 imposes one condition per element instead of one per point.
template <class E>
std::array<Point<E>, E::points> points_of(const Nodal<E>& x, bool mean_dilatation,
                                          PlaneState plane = PlaneState::strain) {
  std::array<Point<E>, E::points> points;
  for (std::size_t q = 0; q < E::points; ++q) points[q] = Point<E>(x, q, plane);
  if (!mean_dilatation || !E::mean_dilatation) return points;
  double volume = 0.0;
  for (const Point<E>& point : points) volume += point.volume;
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i) {
      double sum = 0.0;
      for (const Point<E>& point : points) sum += point.volume * point.trace(a, i);
      for (Point<E>& point : points) point.dilatation[a][i] = sum / volume;
    }
  return points;
}

}  // namespace kacanov::elements
