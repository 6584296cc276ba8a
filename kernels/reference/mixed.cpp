// SPDX-License-Identifier: BSD-3-Clause
// The displacement–pressure form: linear pressure with linear or quadratic displacements.
#include <kacanov/reference.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "cells/elements.hpp"
#include "cells/point.hpp"

namespace kacanov::reference {
namespace {

template <class E>
struct Local {
  elements::Nodal<E> u{};
  std::array<double, E::corners> p{};
};

/// Adds the contribution of one point: f += forces of the stress 2g dev ε(x) + p I, q += tr ε(x) at the
/// corners.
template <class E>
void add_point(const elements::Point<E>& point, double g, const Local<E>& x, std::span<const double> shape,
               Local<E>& y) {
  using Point = elements::Point<E>;
  double h[E::dim][E::dim] = {};  // ∂u_i/∂x_k
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i)
      for (int k = 0; k < E::dim; ++k) h[i][k] += x.u[Point::at(a, i)] * point.gradient[a][k];
  double trace = 0.0, pressure = 0.0;
  for (int i = 0; i < E::dim; ++i) trace += h[i][i];
  for (int c = 0; c < E::corners; ++c) pressure += shape[c] * x.p[c];
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i) {
      double force = (pressure - 2.0 / 3.0 * g * trace) * point.gradient[a][i];
      for (int k = 0; k < E::dim; ++k) force += g * (h[i][k] + h[k][i]) * point.gradient[a][k];
      y.u[Point::at(a, i)] += point.volume * force;
    }
  for (int c = 0; c < E::corners; ++c) y.p[c] += point.volume * shape[c] * trace;
}

/// q −= ∫ (p − p̄) φ/(2g) of a simplex with straight edges and constant g.
template <class E>
void subtract_stabilisation(double volume, double g, const Local<E>& x, Local<E>& y) {
  constexpr double n = E::corners;
  double sum = 0.0;
  for (const double p : x.p) sum += p;
  for (int c = 0; c < E::corners; ++c)
    y.p[c] -= volume / (2.0 * g) * ((x.p[c] + sum) / (n * (n + 1.0)) - sum / (n * n));
}

template <class E>
Local<E> apply_element(const elements::Nodal<E>& coordinates, const Law& law, std::span<const double> g,
                       const Local<E>& x) {
  Local<E> y;
  for (int q = 0; q < E::points; ++q) {
    const elements::Point<E> point(coordinates, static_cast<std::size_t>(q));
    const auto shape = elements::barycentric<E::dim>(E::point[q].data());
    add_point<E>(point, g[q], x, shape, y);
    for (int c = 0; c < E::corners; ++c) y.p[c] -= point.volume * shape[c] / law.bulk * x.p[c];  // lumped
    if constexpr (E::order == 1) subtract_stabilisation<E>(point.volume, g[q], x, y);
  }
  return y;
}

}  // namespace

void apply_mixed(const Body& body, std::span<const double> g, const DisplacementPressure<const double>& x,
                 const DisplacementPressure<double>& y) {
  std::fill(y.u.begin(), y.u.end(), 0.0);
  std::fill(y.p.begin(), y.p.end(), 0.0);
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    using Point = elements::Point<E>;
    if constexpr (!E::simplex) {
      throw std::invalid_argument("the displacement-pressure form is that of tri3, tet4 and tet10, not of " +
                                  std::string(E::name));
    } else {
      for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
        const std::int32_t* node = body.mesh.connectivity.data() + e * E::nodes;
        elements::Nodal<E> coordinates;
        Local<E> local;
        for (int a = 0; a < E::nodes; ++a)
          for (int i = 0; i < E::dim; ++i) {
            coordinates[Point::at(a, i)] = body.mesh.coordinates[Point::at(node[a], i)];
            local.u[Point::at(a, i)] = x.u[Point::at(node[a], i)];
          }
        for (int c = 0; c < E::corners; ++c) local.p[c] = x.p[node[c]];
        const Local<E> result =
            apply_element<E>(coordinates, body.law(e), g.subspan(e * E::points, E::points), local);
        for (int a = 0; a < E::nodes; ++a)
          for (int i = 0; i < E::dim; ++i) y.u[Point::at(node[a], i)] += result.u[Point::at(a, i)];
        for (int c = 0; c < E::corners; ++c) y.p[node[c]] += result.p[c];
      }
    }
  });
}

}  // namespace kacanov::reference
