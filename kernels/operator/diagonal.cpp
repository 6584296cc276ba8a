// SPDX-License-Identifier: BSD-3-Clause
// The diagonals and diagonal blocks of secant and tangent, from the data that their loops read.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "cells/dispatch.hpp"
#include "cells/point.hpp"
#include "law/plane_stress.hpp"
#include "operator/checks.hpp"
#include "operator/passes.hpp"
#include "operator/threads.hpp"
#include "operator/units.hpp"

namespace kacanov {

/// Finds the elements of the slots again in their batches. Calls visit(points, the caller's nodes, law, slot
/// of the first point) for each; slots of an element's points are `lanes` apart.
template <class Real>
template <class E, class Visit>
void BasicOperator<Real>::Data::visit_elements(const BlockRange& range, const simd::Group& group,
                                               const Visit& visit) const {
  using elements::Point;
  const std::size_t lanes = layout.lanes;
  const Units units{type, {}, {}, {}};
  const std::uint32_t nodes = units.nodes_of(group.shape, group.length),
                      count = units.points_of(group.shape, group.length);  // of points
  const std::uint16_t* index = layout.index.data() + range.first_index + group.first_index;
  const Real* records = coordinates.data() + 4 * range.first_record;
  const Law& law = laws[group.law];
  for (std::size_t batch = 0; batch < group.batches; ++batch)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::array<std::int32_t, E::nodes> id{};
      elements::Nodal<E> x;
      for (std::uint32_t p = 0; p < count; p += E::points) {
        const std::size_t slot = range.first_slot + group.first_slot + (batch * count + p) * lanes + lane;
        if (layout.element_point[slot] < 0) continue;
        for (int a = 0; a < E::nodes; ++a) {
          const auto k = static_cast<std::uint32_t>(a);
          const std::size_t node = units.node_of(group.shape, group.length, p / E::points, k);
          const std::size_t record = index[(batch * nodes + node) * lanes + lane];
          id[k] = layout.nodes[range.first_node + record / 4];
          for (int c = 0; c < E::dim; ++c) x[Point<E>::at(a, c)] = static_cast<double>(records[record + c]);
          // Radii count as they are, not from the middle of the block.
          if (plane == PlaneState::axisymmetric)
            x[Point<E>::at(a, 0)] = static_cast<double>(records[record + 2]);
        }
        visit(elements::points_of<E>(x, law.mean_dilatation, plane), id, law, slot);
      }
    }
}

/// Sums blocks: add(point, a, law, slot, block) adds that of node a of an element. Threads have sums of their
/// own for nodes where they meet, which are added in their order.
template <class Real>
template <class Add>
void BasicOperator<Real>::Data::sum_blocks(std::span<Real> blocks, const Add& add) const {
  expect_size(blocks.size(), unknowns * dim(), "blocks");
  const std::size_t size = dim() * dim(), interface_size = layout.interface_node.size();
  std::vector<std::int32_t> place(unknowns / dim(), -1);
  for (std::size_t i = 0; i < interface_size; ++i)
    place[layout.interface_node[i]] = static_cast<std::int32_t>(i);
  std::fill(blocks.begin(), blocks.end(), Real(0));
  std::vector<std::vector<Real>> sums(threads);
  in_team(threads, [&](int t) {
    std::vector<Real>& mine = sums[t];
    mine.assign(interface_size * size, Real(0));
    const auto block_of = [&](std::int32_t node) {
      const std::int32_t at = place[node];
      return at < 0 ? blocks.data() + node * size : mine.data() + at * size;
    };
    const auto add_element = [&]<class E>(E, const auto& at, const auto& node, const Law& law,
                                          std::size_t slot) {
      for (int a = 0; a < E::nodes; ++a) {
        double here[E::dim * E::dim] = {};
        for (std::size_t q = 0; q < E::points; ++q) add(at[q], a, law, slot + q * layout.lanes, here);
        Real* block = block_of(node[a]);
        for (int i = 0; i < E::dim * E::dim; ++i) block[i] += static_cast<Real>(here[i]);
      }
    };
    for (std::size_t b = layout.share[t]; b < layout.share[static_cast<std::size_t>(t) + 1]; ++b)
      for (std::size_t i = 0; i < layout.blocks[b].group_count; ++i)
        elements::dispatch(type, [&]<class E>(E element) {
          visit_elements<E>(layout.blocks[b], layout.groups[layout.blocks[b].first_group + i],
                            [&](const auto& at, const auto& node, const Law& law, std::size_t slot) {
                              add_element(element, at, node, law, slot);
                            });
        });
  });
  for (const auto& mine : sums)
    for (std::size_t i = 0; i < interface_size; ++i)
      for (std::size_t k = 0; k < size; ++k)
        blocks[layout.interface_node[i] * size + k] += mine[i * size + k];
}

namespace {

/// d[i]: entry i % dim of row i of the blocks.
template <class Real>
void take_diagonal(std::span<const Real> blocks, std::size_t dim, std::span<Real> d) {
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = blocks[i * dim + i % dim];
}

}  // namespace

template <class Real>
void BasicOperator<Real>::block_diagonal(std::span<Real> blocks) const {
  const Data& data = *data_;
  data.sum_blocks(blocks, [&](const auto& point, int a, const Law& law, std::size_t slot, double* block) {
    const auto secant = static_cast<double>(data.secant[slot]);
    point.add_diagonal_block(a, data.bulk_at(law, secant), secant, block);
  });
}

template <class Real>
void BasicOperator<Real>::block_diagonal_deviator(std::span<Real> blocks) const {
  const Data& data = *data_;
  if (pressures() == 0) throw std::logic_error("block_diagonal_deviator where nothing is averaged");
  data.sum_blocks(blocks, [&](const auto& point, int a, const Law& law, std::size_t slot, double* block) {
    point.add_diagonal_block(a, law.mean_dilatation ? 0.0 : law.bulk, static_cast<double>(data.secant[slot]),
                             block);
  });
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
  if (!data.has_tangent) throw std::logic_error("block_diagonal_tangent before update_tangent");
  const Aligned<Real>& g = data.tangent_secant.empty() ? data.secant : data.tangent_secant;
  const std::size_t lanes = data.layout.lanes;
  data.sum_blocks(blocks, [&](const auto& point, int a, const Law& law, std::size_t slot, double* block) {
    const auto secant = static_cast<double>(g[slot]);
    point.add_diagonal_block(a, data.bulk_at(law, secant), secant, block);
    // √|2 g'/x| dev ε, component by component over the lanes; see material.hpp.
    const std::size_t lane = slot % lanes;
    const float* t = data.tangent.data() + simd::tangent_floats * (slot - lane) + lane;
    const auto kept = [&](std::size_t k) { return static_cast<double>(t[k * lanes]); };
    const std::array<double, 6> d{kept(0), kept(1), -(kept(0) + kept(1)), kept(2), kept(3), kept(4)};
    point.add_rank_one_block(a, std::signbit(t[0]) ? 1.0 : -1.0, d, block);
  });
}

template <class Real>
void BasicOperator<Real>::diagonal_tangent(std::span<Real> d) const {
  expect_size(d.size(), unknowns(), "d");
  std::vector<Real> blocks(d.size() * data_->dim());
  block_diagonal_tangent(blocks);
  take_diagonal<Real>(blocks, data_->dim(), d);
}

template void BasicOperator<double>::block_diagonal_deviator(std::span<double>) const;
template void BasicOperator<float>::block_diagonal_deviator(std::span<float>) const;
template void BasicOperator<double>::diagonal(std::span<double>) const;
template void BasicOperator<float>::diagonal(std::span<float>) const;
template void BasicOperator<double>::block_diagonal(std::span<double>) const;
template void BasicOperator<float>::block_diagonal(std::span<float>) const;
template void BasicOperator<double>::diagonal_tangent(std::span<double>) const;
template void BasicOperator<float>::diagonal_tangent(std::span<float>) const;
template void BasicOperator<double>::block_diagonal_tangent(std::span<double>) const;
template void BasicOperator<float>::block_diagonal_tangent(std::span<float>) const;

}  // namespace kacanov
