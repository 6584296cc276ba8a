// SPDX-License-Identifier: BSD-3-Clause
// Loop for any element type, one element per lane, with the isoparametric map at its points and B-bar if it
// has it.
#pragma once

#include "cells/elements.hpp"
#include "simd/fan.hpp"

namespace {

/// ∂N/∂ξ at the points, nodes × dim each, in the precision of the lanes; constant for the element type.
template <class E, class Real>
struct ReferenceGradients {
  Real at[E::points][E::nodes][E::dim];
};

template <class E, class Real>
constexpr ReferenceGradients<E, Real> reference_gradients() {
  ReferenceGradients<E, Real> table{};
  for (int q = 0; q < E::points; ++q) {
    const auto d = E::gradients(&E::point[q][0]);
    for (int a = 0; a < E::nodes; ++a)
      for (int k = 0; k < E::dim; ++k) table.at[q][a][k] = static_cast<Real>(d[a * E::dim + k]);
  }
  return table;
}

/// N at the points, points × nodes.
template <class E, class Real>
struct ReferenceValues {
  Real at[E::points][E::nodes];
};

template <class E, class Real>
constexpr ReferenceValues<E, Real> reference_values() {
  ReferenceValues<E, Real> table{};
  for (int q = 0; q < E::points; ++q) {
    const auto n = E::values(&E::point[q][0]);
    for (int a = 0; a < E::nodes; ++a) table.at[q][a] = static_cast<Real>(n[a]);
  }
  return table;
}

/// Corner weights at the points, points × corners: barycentric coordinates, for elements that average at
/// corners.
template <class E, class Real>
struct CornerShares {
  Real at[E::points][E::corners];
};

template <class E, class Real>
constexpr CornerShares<E, Real> corner_shares() {
  CornerShares<E, Real> table{};
  if constexpr (E::corner_dilatation)
    for (int q = 0; q < E::points; ++q) {
      const auto share = kacanov::elements::barycentric<E::dim>(&E::point[q][0]);
      for (int a = 0; a < E::corners; ++a) table.at[q][a] = static_cast<Real>(share[a]);
    }
  return table;
}

/// ∫ N tr ε around each corner, for elements that average at corners.
template <class L, class Real, class E>
inline void element_changes(const Block<Real>& block, const Group& group, Vectors<Real> vectors) {
  using V = typename L::V;
  static constexpr auto gradients = reference_gradients<E, Real>();
  static constexpr auto shares = corner_shares<E, Real>();
  const std::uint16_t* at = block.index + group.first_index;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch, at += E::nodes * L::width) {
    V x[E::nodes][3];
    for (int a = 0; a < E::nodes; ++a) L::load3(block.coordinates, at + a * L::width, x[a]);
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      V d[E::nodes][3], change[E::corners] = {};
      for (int a = 0; a < E::nodes; ++a) L::load3(vectors.u + offset, at + a * L::width, d[a]);
      for (int q = 0; q < E::points; ++q) {
        V j[3][3] = {}, slope[3][3] = {}, trace{};  // ∂x/∂ξ_k, ∂u/∂ξ_k
        for (int a = 0; a < E::nodes; ++a)
          for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i) {
              j[k][i] += x[a][i] * gradients.at[q][a][k];
              slope[k][i] += d[a][i] * gradients.at[q][a][k];
            }
        for (int k = 0; k < 3; ++k) {
          V c[3];
          cross(j[(k + 1) % 3], j[(k + 2) % 3], c);
          trace += inner(slope[k], c);
        }
        for (int a = 0; a < E::corners; ++a) change[a] += Real(E::weight) * shares.at[q][a] * trace;
      }
      for (int a = 0; a < E::corners; ++a)
        add_last<L, Real>(vectors.f + offset, at + a * L::width, change[a]);
    }
  }
}

/// Geometry of all points first, then every input vector, as for fans. `round`: axisymmetric.
template <class L, class Real, class E, bool round = false, class Material>
inline void element_loop(const Block<Real>& block, const Group& group, const Material& material,
                         Vectors<Real> vectors) {
  using V = typename L::V;
  constexpr int width = L::width;
  static constexpr auto gradients = reference_gradients<E, Real>();
  [[maybe_unused]] static constexpr auto values = reference_values<E, Real>();
  [[maybe_unused]] static constexpr auto shares = corner_shares<E, Real>();
  bool mean = false;  // B-bar, or averages at corners
  constexpr bool has_mean = E::mean_dilatation || E::corner_dilatation;
  if constexpr (has_mean) mean = block.laws[group.law].mean_dilatation;
  const auto choose = [&]() -> decltype(auto) {
    if constexpr (has_mean)
      return mean ? material.without_bulk() : material;
    else
      return (material);
  };
  const Material& at_point = choose();
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    fetch_ahead(at, E::nodes * width);
    material.fetch_ahead(point, E::points * width);
    V c[E::points][3][3], det[E::points], w[E::points];  // c: det ∇ξ_k
    // Circumference of the full circle, and det/r: the hoop strain is u_x/r.
    [[maybe_unused]] V circle[E::points], hoop[E::points];
    {
      V x[E::nodes][3];
      for (int a = 0; a < E::nodes; ++a) L::load3(block.coordinates, at + a * width, x[a]);
      for (int q = 0; q < E::points; ++q) {
        V j[3][3] = {};  // ∂x/∂ξ_k
        for (int a = 0; a < E::nodes; ++a)
          for (int k = 0; k < E::dim; ++k)
            for (int i = 0; i < E::dim; ++i) j[k][i] += x[a][i] * gradients.at[q][a][k];
        if constexpr (E::dim == 2) j[2][2] = Real(1) - V{};
        for (int k = 0; k < 3; ++k) cross(j[(k + 1) % 3], j[(k + 2) % 3], c[q][k]);
        det[q] = inner(j[0], c[q][0]);
        w[q] = Real(E::weight) / det[q];
        if constexpr (round) {
          V r{};
          for (int a = 0; a < E::nodes; ++a) r += x[a][2] * values.at[q][a];
          circle[q] = Real(6.28318530717958647693) * r;
          hoop[q] = det[q] / r;
          w[q] *= circle[q];
        }
      }
    }
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      V d[E::nodes][3], force[E::nodes][3] = {};
      for (int a = 0; a < E::nodes; ++a) L::load3(vectors.u + offset, at + a * width, d[a]);
      const auto displacement_gradient = [&](int q, V(&h)[9]) __attribute__((always_inline)) {
        for (int k = 0; k < E::dim; ++k) {
          V slope[3] = {};  // ∂u/∂ξ_k
          for (int a = 0; a < E::nodes; ++a)
            for (int i = 0; i < E::dim; ++i) slope[i] += d[a][i] * gradients.at[q][a][k];
          for (int i = 0; i < E::dim; ++i)
            for (int m = 0; m < E::dim; ++m) h[3 * i + m] += slope[i] * c[q][k][m];
        }
        if constexpr (round) {
          V along{};
          for (int a = 0; a < E::nodes; ++a) along += d[a][0] * values.at[q][a];
          h[8] = along * hoop[q];
        }
      };
      [[maybe_unused]] V pressure{};  // weight times the pressure of the mean dilatation
      if constexpr (E::mean_dilatation)
        if (mean) {
          V change{}, volume{};
          for (int q = 0; q < E::points; ++q) {
            V h[9] = {};
            displacement_gradient(q, h);
            if constexpr (round)
              change += circle[q] * (h[0] + h[4] + h[8]), volume += circle[q] * det[q];
            else
              change += h[0] + h[4] + h[8], volume += det[q];
          }
          pressure = Real(E::weight) * material.bulk() * change / volume;
          material.add_energy(Real(0.5) * pressure * change);
        }
      [[maybe_unused]] V at_corner[E::corners] = {};  // weight times the pressures of the corner averages
      if constexpr (E::corner_dilatation)
        for (int a = 0; mean && a < E::corners; ++a)
          at_corner[a] = Real(E::weight) * material.bulk() * L::load_last(vectors.u + offset, at + a * width);
      for (int q = 0; q < E::points; ++q) {
        V h[9] = {};
        displacement_gradient(q, h);
        const std::size_t place = point + static_cast<std::size_t>(q);
        Sym<V> s;
        if constexpr (round)
          s = at_point.stress(strain_of(h), det[q], w[q], Real(E::weight) * circle[q], place);
        else
          s = at_point.stress(strain_of(h), det[q], w[q], Real(E::weight), place);
        if constexpr (E::mean_dilatation && round) {
          const V here = pressure * circle[q];
          s.xx += here, s.yy += here, s.zz += here;
        } else if constexpr (has_mean) {
          if constexpr (E::corner_dilatation) {
            pressure = V{};
            for (int a = 0; a < E::corners; ++a) pressure += shares.at[q][a] * at_corner[a];
          }
          s.xx += pressure, s.yy += pressure, s.zz += pressure;
        }
        if constexpr (round) {
          const V t = s.zz * hoop[q];
          for (int a = 0; a < E::nodes; ++a) force[a][0] += t * values.at[q][a];
        }
        for (int k = 0; k < E::dim; ++k) {
          V t[3];
          multiply(s, c[q][k], t);
          for (int a = 0; a < E::nodes; ++a)
            for (int i = 0; i < E::dim; ++i) force[a][i] += t[i] * gradients.at[q][a][k];
        }
      }
      for (int a = 0; a < E::nodes; ++a) L::add3(vectors.f + offset, at + a * width, force[a]);
    }
    at += E::nodes * width;
    point += E::points;
  }
}

}  // namespace
