// SPDX-License-Identifier: BSD-3-Clause
// The table of loops of one instruction set, built on its `Lanes`. Each instruction set's source includes it
// once.
#pragma once

#include "simd/element.hpp"
#include "simd/hex8.hpp"
#include "simd/pressure.hpp"
#include "simd/tet10.hpp"

namespace {

using kacanov::ElementType;
using kacanov::PlaneState;
using kacanov::elements::Quad4;
using kacanov::elements::Tet10;
using kacanov::elements::Tri3;
using kacanov::simd::Kernels;
using kacanov::simd::nodes_ahead;
using kacanov::simd::Shape;

template <class Real>
struct Loops {
  using L = Lanes<Real>;

  template <int dim>
  static typename L::Record load_row(const Real* p) {
    if constexpr (dim == 3)
      return L::load_row(p);
    else
      return typename L::Record{p[0], p[1]};
  }
  template <int dim>
  static void store_row(Real* p, typename L::Record record) {
    if constexpr (dim == 3)
      L::store_row(p, record);
    else
      p[0] = record[0], p[1] = record[1];
  }

  /// gather and scatter fetch all memory of a block in bursts. Prefetching it gradually during the arithmetic
  /// cost more than the burst: a pending cache line costs loads that miss the first-level cache about 3 ns
  /// (Zen 5).
  template <int dim>
  static void gather_in(const Block<Real>& block, const Real* x, Real* u, Real* f) {
    const std::int32_t* nodes = block.nodes;
    const auto copy = [&](std::size_t i) {
      __builtin_prefetch(x + dim * std::ptrdiff_t{nodes[i + nodes_ahead]});
      L::store_record(u + 4 * i, load_row<dim>(x + dim * std::ptrdiff_t{nodes[i]}));
    };
    const std::size_t ends[3] = {block.first, block.again, block.count};
    for (std::size_t kind = 0, i = 0; kind < 3; ++kind) {
      for (const std::size_t end = i + block.placed[kind]; i < end; ++i) {
        __builtin_prefetch(block.coordinates + 4 * i, 0, 2);
        copy(i);
      }
      for (; i < ends[kind]; ++i) copy(i);
    }
    const std::size_t end = 4 * std::size_t{block.count + block.padding};
    for (std::size_t i = 4 * std::size_t{block.count}; i < end; ++i) u[i] = 0;
    for (std::size_t i = 0; i < end; ++i) f[i] = 0;
  }
  static void gather(const Block<Real>& block, int dim, const Real* x, Real* u, Real* f) {
    if (dim == 3)
      gather_in<3>(block, x, u, f);
    else
      gather_in<2>(block, x, u, f);
  }

  template <int dim>
  static void scatter_in(const Block<Real>& block, const Real* f, Real* y, Real* sums) {
    const auto row = [&](std::size_t i) { return y + dim * std::ptrdiff_t{block.nodes[i]}; };
    std::size_t i = 0;
    for (; i < block.first; ++i) {
      __builtin_prefetch(row(i + nodes_ahead), 1);
      store_row<dim>(row(i), L::load_record(f + 4 * i));
    }
    for (; i < block.again; ++i) {
      __builtin_prefetch(row(i + nodes_ahead), 1);
      store_row<dim>(row(i), load_row<dim>(row(i)) + L::load_record(f + 4 * i));
    }
    const std::int32_t* slot = block.shared;
    for (; i < block.count; ++i, ++slot)
      for (std::size_t k = 0; k < dim; ++k)
        sums[3 * std::ptrdiff_t{*slot} + std::ptrdiff_t(k)] += f[4 * i + k];
  }
  static void scatter(const Block<Real>& block, int dim, const Real* f, Real* y, Real* sums) {
    if (dim == 3)
      scatter_in<3>(block, f, y, sums);
    else
      scatter_in<2>(block, f, y, sums);
  }

  static double dot(const Block<Real>& block, const Real* u, const Real* f) {
    double sum[4] = {};  // one per entry of a record; the last entry of f is zero
    for (std::size_t i = 0; i < block.count; ++i)
      for (std::size_t k = 0; k < 3; ++k) sum[k] += double(u[4 * i + k]) * double(f[4 * i + k]);
    return sum[0] + sum[1] + sum[2];
  }

  template <bool averaged, class Material>
  static void over_fans(const Block<Real>& block, const Group& group, const Material& material,
                        const Vectors<Real>& vectors) {
    closed_or_open(group, [&]<bool closed>() {
      fan_loop_of_length<L, Real, closed, averaged>(block, group, material, vectors);
    });
  }

  template <class MakeMaterial>
  static void sweep(const Block<Real>& block, const Vectors<Real>& vectors, MakeMaterial&& make) {
    for (std::size_t i = 0; i < block.group_count; ++i) {
      const Group& group = block.groups[i];
      const auto material = make(group);
      const auto elements = [&]<class E>() { element_loop<L, Real, E>(block, group, material, vectors); };
      switch (group.type) {
        case ElementType::tri3: elements.template operator()<Tri3>(); break;
        case ElementType::quad4: elements.template operator()<Quad4>(); break;
        case ElementType::tet4:
          if (block.laws[group.law].mean_dilatation)
            over_fans<true>(block, group, material, vectors);
          else
            over_fans<false>(block, group, material, vectors);
          break;
        case ElementType::tet10:
          if (group.shape == Shape::general)
            elements.template operator()<Tet10>();
          else if (block.laws[group.law].mean_dilatation)
            quadratic_fan_loop<L, Real, true>(block, group, material, vectors);
          else
            quadratic_fan_loop<L, Real, false>(block, group, material, vectors);
          break;
        case ElementType::hex8:
          if constexpr (decltype(material)::frozen)
            if (group.shape == Shape::affine) {
              affine_hex_loop<L, Real>(block, group, material, vectors);
              break;
            }
          hex_loop<L, Real>(block, group, material, vectors);
          break;
      }
    }
  }

  /// sweep() for plane stress and axisymmetric meshes.
  template <bool round, class MakeMaterial>
  static void sweep_plane(const Block<Real>& block, const Vectors<Real>& vectors, MakeMaterial&& make) {
    for (std::size_t i = 0; i < block.group_count; ++i) {
      const Group& group = block.groups[i];
      const auto material = make(group);
      if (group.type == ElementType::quad4)
        element_loop<L, Real, Quad4, round>(block, group, material, vectors);
      else
        element_loop<L, Real, Tri3, round>(block, group, material, vectors);
    }
  }

  static void apply(const Block<Real>& block, const Vectors<Real>& vectors) {
    if (block.plane == PlaneState::stress)
      return sweep_plane<false>(
          block, vectors, [&](const Group& group) { return SecantMaterial<L, Real, true>(block, group); });
    if (block.plane == PlaneState::axisymmetric)
      return sweep_plane<true>(block, vectors,
                               [&](const Group& group) { return SecantMaterial<L, Real>(block, group); });
    sweep(block, vectors, [&](const Group& group) { return SecantMaterial<L, Real>(block, group); });
  }
  static void apply_tangent(const Block<Real>& block, const Vectors<Real>& vectors) {
    if (block.plane == PlaneState::stress)
      return sweep_plane<false>(
          block, vectors, [&](const Group& group) { return TangentMaterial<L, Real, true>(block, group); });
    if (block.plane == PlaneState::axisymmetric)
      return sweep_plane<true>(block, vectors,
                               [&](const Group& group) { return TangentMaterial<L, Real>(block, group); });
    sweep(block, vectors, [&](const Group& group) { return TangentMaterial<L, Real>(block, group); });
  }
  static void nonlinear(const Block<Real>& block, const Real* u, Real* f, Nonlinear* out) {
    if (block.plane == PlaneState::stress)
      return sweep_plane<false>(block, {u, f}, [&](const Group& group) {
        return NonlinearMaterial<L, Real, false, true>(block, group, *out);
      });
    if (block.plane == PlaneState::axisymmetric)
      return sweep_plane<true>(block, {u, f}, [&](const Group& group) {
        return NonlinearMaterial<L, Real, false>(block, group, *out);
      });
    if (block.outside.strain != nullptr || block.outside.secant != nullptr)
      sweep(block, {u, f},
            [&](const Group& group) { return NonlinearMaterial<L, Real, true>(block, group, *out); });
    else
      sweep(block, {u, f},
            [&](const Group& group) { return NonlinearMaterial<L, Real, false>(block, group, *out); });
  }

  /// Calls linear(group), quadratic(group) or curved(group) for the groups that average around corners.
  template <class Linear, class Quadratic, class Curved>
  static void over_averaged(const Block<Real>& block, const Linear& linear, const Quadratic& quadratic,
                            const Curved& curved) {
    for (std::size_t i = 0; i < block.group_count; ++i) {
      const Group& group = block.groups[i];
      if (!block.laws[group.law].mean_dilatation) continue;
      if (group.type == ElementType::tet4)
        linear(group);
      else if (group.type == ElementType::tet10 && group.shape == Shape::general)
        curved(group);
      else if (group.type == ElementType::tet10)
        quadratic(group);
    }
  }
  static void corner_changes(const Block<Real>& block, const Vectors<Real>& vectors) {
    over_averaged(
        block,
        [&](const Group& group) {
          closed_or_open(group,
                         [&]<bool closed>() { linear_fan_changes<L, Real, closed>(block, group, vectors); });
        },
        [&](const Group& group) { quadratic_fan_changes<L, Real>(block, group, vectors); },
        [&](const Group& group) { element_changes<L, Real, Tet10>(block, group, vectors); });
  }
  static void corner_forces(const Block<Real>& block, const Vectors<Real>& vectors) {
    over_averaged(
        block,
        [&](const Group& group) {
          closed_or_open(
              group, [&]<bool closed>() { linear_fan_pressures<L, Real, closed>(block, group, vectors); });
        },
        [&](const Group& group) { quadratic_fan_pressures<L, Real>(block, group, vectors); },
        [&](const Group& group) { element_pressures<L, Real, Tet10>(block, group, vectors); });
  }

  static constexpr Kernels<Real> table{L::width,      gather, scatter,       dot,      corner_changes,
                                       corner_forces, apply,  apply_tangent, nonlinear};
};

}  // namespace
