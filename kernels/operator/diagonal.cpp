// SPDX-License-Identifier: BSD-3-Clause
// The diagonal and the diagonal blocks of B, from the data that its loops read.
#include <algorithm>
#include <array>

#include "cells/dispatch.hpp"
#include "cells/point.hpp"
#include "operator/checks.hpp"
#include "operator/passes.hpp"

namespace kacanov {

/// Finds the element of every slot again in its batch and adds what each of its nodes has on the diagonal.
template <class Real>
template <class E>
void BasicOperator<Real>::Data::add_diagonals(const BlockRange& range, const simd::Group& group,
                                              std::span<Real> blocks) const {
  using elements::Point;
  const bool fan = group.shape == simd::Shape::open_fan || group.shape == simd::Shape::closed_fan;
  const std::size_t lanes = layout.lanes;
  const std::size_t element_points = fan ? group.length : E::points,
                    ring_ends = group.shape == simd::Shape::closed_fan ? 2 : 3,
                    nodes = fan ? element_points + ring_ends : E::nodes;
  const std::uint16_t* index = layout.index.data() + range.first_index + group.first_index;
  const Real* records = coordinates.data() + 4 * range.first_record;
  for (std::size_t batch = 0; batch < group.batches; ++batch)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::array<std::size_t, E::nodes> record{};
      std::array<Point<E>, E::points> at{};  // of the element at hand
      for (std::size_t p = 0; p < element_points; ++p) {
        const std::size_t slot =
            range.first_slot + group.first_slot + (batch * element_points + p) * lanes + lane;
        if (layout.element_point[slot] < 0) continue;
        if (fan || p == 0) {
          elements::Nodal<E> x;
          for (int a = 0; a < E::nodes; ++a) {
            const std::size_t k = a;
            const std::size_t node = fan && k >= 2 ? 2 + (p + k - 2) % (nodes - 2) : k;
            record[k] = index[(batch * nodes + node) * lanes + lane];
            for (int c = 0; c < E::dim; ++c)
              x[Point<E>::at(a, c)] = static_cast<double>(records[record[k] + c]);
          }
          at = elements::points_of<E>(x, laws[group.law].mean_dilatation);
        }
        const Point<E>& point = at[fan ? 0 : p];
        for (int a = 0; a < E::nodes; ++a) {
          const std::int32_t id = layout.nodes[range.first_node + record[a] / 4];
          point.add_diagonal_block(a, laws[group.law].bulk, static_cast<double>(secant[slot]),
                                   blocks.data() + Point<E>::at(id, 0) * E::dim);
        }
      }
    }
}

template <class Real>
void BasicOperator<Real>::block_diagonal(std::span<Real> blocks) const {
  const Data& data = *data_;
  expect_size(blocks.size(), data.unknowns * data.dim(), "blocks");
  std::fill(blocks.begin(), blocks.end(), Real(0));
  for (const BlockRange& range : data.layout.blocks)
    for (std::size_t i = 0; i < range.group_count; ++i)
      elements::dispatch(data.type, [&]<class E>(E) {
        data.template add_diagonals<E>(range, data.layout.groups[range.first_group + i], blocks);
      });
}

template <class Real>
void BasicOperator<Real>::diagonal(std::span<Real> d) const {
  expect_size(d.size(), unknowns(), "d");
  const std::size_t dim = data_->dim();
  std::vector<Real> blocks(d.size() * dim);
  block_diagonal(blocks);
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = blocks[i * dim + i % dim];
}

template void BasicOperator<double>::diagonal(std::span<double>) const;
template void BasicOperator<float>::diagonal(std::span<float>) const;
template void BasicOperator<double>::block_diagonal(std::span<double>) const;
template void BasicOperator<float>::block_diagonal(std::span<float>) const;

}  // namespace kacanov
