// SPDX-License-Identifier: BSD-3-Clause
// Diagonals and diagonal blocks of secant and tangent, from the data of their loops.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "cells/elements.hpp"
#include "cells/parallelepiped.hpp"
#include "cells/point.hpp"
#include "cells/straight.hpp"
#include "law/plane_stress.hpp"
#include "operator/checks.hpp"
#include "operator/threaded_loops.hpp"
#include "operator/threads.hpp"
#include "operator/work_items.hpp"

namespace kacanov {
namespace {

/// An element in the batches: its nodal coordinates, and the slot of its first point.
template <class E>
struct SlotElement {
  const elements::Nodal<E>& x;
  bool affine;
  const Law& law;
  std::size_t slot;
};

}  // namespace

/// Reconstructs the elements from the slots of the batches. Calls visit(nodal coordinates, the caller's
/// nodes, law, slot of the first point) for each element with a wanted node; slots of an element's points are
/// `lanes` apart.
template <class Real>
template <class E, class Visit>
void BasicOperator<Real>::Data::visit_elements(const BlockRange& range, const simd::Group& group,
                                               std::span<const char> wanted, const Visit& visit) const {
  using elements::Point;
  const std::size_t lanes = layout.lanes;
  const WorkItems items{mesh.type, {}, {}, {}};
  const std::uint32_t nodes = items.nodes_of(group.shape, group.length),
                      count = items.points_of(group.shape, group.length);  // number of points
  const std::uint16_t* index = layout.index.data() + range.first_index + group.first_index;
  const Real* records = coordinates.data() + 4 * range.first_record;
  const Law& law = materials.laws[group.law];
  std::vector<std::uint32_t> node_of;  // nodes of an item, element by element
  for (std::uint32_t p = 0; p < count; p += E::points)
    for (std::uint32_t a = 0; a < E::nodes; ++a)
      node_of.push_back(items.node_of(group.shape, group.length, p / E::points, a));
  for (std::size_t batch = 0; batch < group.batches; ++batch)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::array<std::int32_t, E::nodes> id{};
      elements::Nodal<E> x;
      for (std::uint32_t p = 0; p < count; p += E::points) {
        const std::size_t slot = range.first_slot + group.first_slot + (batch * count + p) * lanes + lane;
        if (layout.element_point[slot] < 0) continue;
        std::array<std::size_t, E::nodes> at;  // of the node records
        bool asked = wanted.empty();
        for (std::size_t k = 0; k < at.size(); ++k) {
          at[k] = index[(batch * nodes + node_of[p / E::points * E::nodes + k]) * lanes + lane];
          id[k] = layout.nodes[range.first_node + at[k] / 4];
          asked = asked || wanted[static_cast<std::size_t>(id[k])] != 0;
        }
        if (!asked) continue;
        for (int a = 0; a < E::nodes; ++a) {
          const std::size_t record = at[static_cast<std::size_t>(a)];
          for (int c = 0; c < E::dim; ++c) x[Point<E>::at(a, c)] = static_cast<double>(records[record + c]);
          // Radii are absolute, not relative to the centre of the block.
          if (mesh.plane == PlaneState::axisymmetric)
            x[Point<E>::at(a, 0)] = static_cast<double>(records[record + 2]);
        }
        visit(x, id, law, slot);
      }
    }
}

/// Sums blocks: add(SlotElement, blocks) adds those of one element's nodes. Threads have private sums for
/// shared nodes, which are added in thread order.
template <class Real>
template <class Add>
void BasicOperator<Real>::Data::sum_blocks(std::span<Real> blocks, std::span<const char> wanted,
                                           const Add& add) const {
  expect_size(blocks.size(), mesh.unknowns * dim(), "blocks");
  if (!wanted.empty()) expect_size(wanted.size(), mesh.unknowns / dim(), "wanted");
  const std::size_t size = dim() * dim(), interface_size = layout.interface_node.size();
  std::vector<std::int32_t> place(mesh.unknowns / dim(), -1);
  for (std::size_t i = 0; i < interface_size; ++i)
    place[layout.interface_node[i]] = static_cast<std::int32_t>(i);
  std::fill(blocks.begin(), blocks.end(), Real(0));
  std::vector<std::vector<Real>> sums(machine.threads);
  in_team(machine.threads, [&](int t) {
    std::vector<Real>& mine = sums[t];
    mine.assign(interface_size * size, Real(0));
    const auto block_of = [&](std::int32_t node) {
      const std::int32_t at = place[node];
      return at < 0 ? blocks.data() + node * size : mine.data() + at * size;
    };
    for (std::size_t b = layout.share[t]; b < layout.share[static_cast<std::size_t>(t) + 1]; ++b)
      for (std::size_t i = 0; i < layout.blocks[b].group_count; ++i)
        elements::dispatch(mesh.type, [&]<class E>(E) {
          const simd::Group& group = layout.groups[layout.blocks[b].first_group + i];
          const bool affine = group.shape != simd::Shape::general;
          visit_elements<E>(layout.blocks[b], group, wanted,
                            [&](const auto& x, const auto& node, const Law& law, std::size_t slot) {
                              double here[E::nodes][E::dim * E::dim] = {};
                              add(SlotElement<E>{x, affine, law, slot}, here);
                              for (int a = 0; a < E::nodes; ++a) {
                                Real* block = block_of(node[a]);
                                for (int k = 0; k < E::dim * E::dim; ++k)
                                  block[k] += static_cast<Real>(here[a][k]);
                              }
                            });
        });
  });
  for (const auto& mine : sums)
    for (std::size_t i = 0; i < interface_size; ++i)
      for (std::size_t k = 0; k < size; ++k)
        blocks[layout.interface_node[i] * size + k] += mine[i * size + k];
}

namespace {

/// Calls add(point, a, slot, block) for every node and point of an element.
template <class E, class Add>
void over_points(const std::array<elements::Point<E>, E::points>& points, std::size_t slot, std::size_t lanes,
                 double (&blocks)[E::nodes][E::dim * E::dim], const Add& add) {
  for (int a = 0; a < E::nodes; ++a)
    for (std::size_t q = 0; q < E::points; ++q) add(points[q], a, slot + q * lanes, blocks[a]);
}

/// Copies the diagonals of the blocks: d[i] is entry i % dim of row i.
template <class Real>
void take_diagonal(std::span<const Real> blocks, std::size_t dim, std::span<Real> d) {
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = blocks[i * dim + i % dim];
}

}  // namespace

/// Blocks of the secant, with the volumetric part for the modulus bulk(law, g).
template <class Real>
template <class Bulk>
void BasicOperator<Real>::Data::sum_secant_blocks(std::span<Real> blocks, std::span<const char> wanted,
                                                  const Bulk& bulk) const {
  const std::size_t lanes = layout.lanes;
  sum_blocks(blocks, wanted, [&]<class E>(const SlotElement<E>& of, auto& here) {
    const elements::Nodal<E>& x = of.x;
    const Law& law = of.law;
    const bool affine = of.affine;
    const std::size_t slot = of.slot;
    const auto g = [&](std::size_t at) { return static_cast<double>(values.secant[at]); };
    if constexpr (E::type == ElementType::hex8)
      if (affine) {
        std::array<double, E::points> at;
        for (std::size_t q = 0; q < E::points; ++q) at[q] = g(slot + q * lanes);
        return elements::Parallelepiped(x.data()).add_diagonal_blocks(bulk(law, at[0]), law.mean_dilatation,
                                                                      at, here);
      }
    if constexpr (E::simplex && E::dim == 3)
      if (affine) {
        std::array<double, E::points> at;
        for (std::size_t q = 0; q < E::points; ++q) at[q] = g(slot + q * lanes);
        return elements::StraightSides(x.data()).add_diagonal_blocks(bulk(law, at[0]), at, here);
      }
    over_points<E>(elements::points_of<E>(x, law.mean_dilatation, mesh.plane), slot, lanes, here,
                   [&](const auto& point, int a, std::size_t at, double* block) {
                     point.add_diagonal_block(a, bulk(law, g(at)), g(at), block);
                   });
  });
}

template <class Real>
void BasicOperator<Real>::block_diagonal(std::span<Real> blocks, std::span<const char> wanted) const {
  data_->sum_secant_blocks(blocks, wanted, [&](const Law& law, double g) { return data_->bulk_at(law, g); });
}

template <class Real>
void BasicOperator<Real>::block_diagonal_deviator(std::span<Real> blocks,
                                                  std::span<const char> wanted) const {
  if (!data_->averages()) throw std::logic_error("block_diagonal_deviator where nothing is averaged");
  data_->sum_secant_blocks(blocks, wanted,
                           [](const Law& law, double) { return law.mean_dilatation ? 0.0 : law.bulk; });
}

template <class Real>
void BasicOperator<Real>::diagonal(std::span<Real> d) const {
  expect_size(d.size(), unknowns(), "d");
  std::vector<Real> blocks(d.size() * data_->dim());
  block_diagonal(blocks);
  take_diagonal<Real>(blocks, data_->dim(), d);
}

template <class Real>
void BasicOperator<Real>::block_diagonal_tangent(std::span<Real> blocks) const {
  const Data& data = *data_;
  if (!data.tangent.present) throw std::logic_error("block_diagonal_tangent before update_tangent");
  const Aligned<Real>& g = data.tangent.secant.empty() ? data.values.secant : data.tangent.secant;
  const std::size_t lanes = data.layout.lanes;
  data.sum_blocks(blocks, {}, [&]<class E>(const SlotElement<E>& of, auto& here) {
    over_points<E>(elements::points_of<E>(of.x, of.law.mean_dilatation, data.mesh.plane), of.slot, lanes,
                   here, [&](const auto& point, int a, std::size_t at, double* block) {
                     const auto secant = static_cast<double>(g[at]);
                     point.add_diagonal_block(a, data.bulk_at(of.law, secant), secant, block);
                     // √|2 g'/x| dev ε, components strided by the lanes; see material.hpp.
                     const std::size_t lane = at % lanes;
                     const float* t = data.tangent.floats.data() + simd::tangent_floats * (at - lane) + lane;
                     const auto kept = [&](std::size_t k) { return static_cast<double>(t[k * lanes]); };
                     const std::array<double, 6> d{kept(0), kept(1), -(kept(0) + kept(1)),
                                                   kept(2), kept(3), kept(4)};
                     point.add_rank_one_block(a, std::signbit(t[0]) ? 1.0 : -1.0, d, block);
                   });
  });
}

template <class Real>
void BasicOperator<Real>::diagonal_tangent(std::span<Real> d) const {
  expect_size(d.size(), unknowns(), "d");
  std::vector<Real> blocks(d.size() * data_->dim());
  block_diagonal_tangent(blocks);
  take_diagonal<Real>(blocks, data_->dim(), d);
}

template void BasicOperator<double>::block_diagonal_deviator(std::span<double>, std::span<const char>) const;
template void BasicOperator<float>::block_diagonal_deviator(std::span<float>, std::span<const char>) const;
template void BasicOperator<double>::diagonal(std::span<double>) const;
template void BasicOperator<float>::diagonal(std::span<float>) const;
template void BasicOperator<double>::block_diagonal(std::span<double>, std::span<const char>) const;
template void BasicOperator<float>::block_diagonal(std::span<float>, std::span<const char>) const;
template void BasicOperator<double>::diagonal_tangent(std::span<double>) const;
template void BasicOperator<float>::diagonal_tangent(std::span<float>) const;
template void BasicOperator<double>::block_diagonal_tangent(std::span<double>) const;
template void BasicOperator<float>::block_diagonal_tangent(std::span<float>) const;

}  // namespace kacanov
