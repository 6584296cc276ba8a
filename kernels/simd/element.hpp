// SPDX-License-Identifier: BSD-3-Clause
// Elements one by one, an element a lane, by the isoparametric map at their quadrature points.
#pragma once

#include "elements/hex8.hpp"
#include "elements/tet10.hpp"
#include "elements/tri3.hpp"
#include "fan.hpp"

namespace {

/// ∂N/∂ξ at a point, nodes × dim, in the precision of the lanes: a constant of the element.
template <class E, class Real>
struct ReferenceGradients {
  Real at[E::points][E::nodes][E::dim];
};

template <class E, class Real>
constexpr ReferenceGradients<E, Real> reference_gradients() {
  ReferenceGradients<E, Real> table{};
  for (int q = 0; q < E::points; ++q) {
    const auto d = E::gradients(&E::point[static_cast<std::size_t>(q)][0]);
    for (int a = 0; a < E::nodes; ++a)
      for (int k = 0; k < E::dim; ++k)
        table.at[q][a][k] = static_cast<Real>(d[static_cast<std::size_t>(a * E::dim + k)]);
  }
  return table;
}

template <class L, class Real, class E, int vectors, class Material>
inline void element_loop(const Block<Real>& block, const Group& group, const Material& material,
                         const Real* u, Real* f, std::size_t stride) {
  using V = typename L::V;
  constexpr int width = L::width;
  static constexpr auto gradients = reference_gradients<E, Real>();
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch, at += E::nodes * width) {
    V x[E::nodes][3], d[vectors][E::nodes][3], force[vectors][E::nodes][3] = {};
    for (int a = 0; a < E::nodes; ++a) L::load3(block.coordinates, at + a * width, x[a]);
    for (int v = 0; v < vectors; ++v)
      for (int a = 0; a < E::nodes; ++a) L::load3(u + v * stride, at + a * width, d[v][a]);
    for (int q = 0; q < E::points; ++q, ++point) {
      V j[3][3] = {}, c[3][3];  // ∂x/∂ξ_k, and what det ∇ξ_k is
      for (int a = 0; a < E::nodes; ++a)
        for (int k = 0; k < E::dim; ++k)
          for (int i = 0; i < E::dim; ++i) j[k][i] += x[a][i] * gradients.at[q][a][k];
      if constexpr (E::dim == 2) j[2][2] = Real(1) - V{};
      cross(j[1], j[2], c[0]);
      cross(j[2], j[0], c[1]);
      cross(j[0], j[1], c[2]);
      const V det = inner(j[0], c[0]), w = Real(E::weight) / det;
      for (int v = 0; v < vectors; ++v) {
        V h[9] = {};
        for (int k = 0; k < E::dim; ++k) {
          V slope[3] = {};
          for (int a = 0; a < E::nodes; ++a)
            for (int i = 0; i < E::dim; ++i) slope[i] += d[v][a][i] * gradients.at[q][a][k];
          for (int i = 0; i < E::dim; ++i)
            for (int m = 0; m < E::dim; ++m) h[3 * i + m] += slope[i] * c[k][m];
        }
        const Sym<V> s = material.stress(h, det, w, Real(E::weight), point);
        for (int k = 0; k < E::dim; ++k) {
          V t[3];
          multiply(s, c[k], t);
          for (int a = 0; a < E::nodes; ++a)
            for (int i = 0; i < E::dim; ++i) force[v][a][i] += t[i] * gradients.at[q][a][k];
        }
      }
    }
    for (int v = 0; v < vectors; ++v)
      for (int a = 0; a < E::nodes; ++a) L::add3(f + v * stride, at + a * width, force[v][a]);
  }
}

}  // namespace
