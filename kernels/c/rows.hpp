// SPDX-License-Identifier: BSD-3-Clause
// The caller's changes to the operator's rows: the identity at constraints and at nodes without elements, and
// added node blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "c/handle.hpp"

namespace kacanov::c_api {

/// Calls each(i) for every unknown with a row of the identity.
template <class Each>
void each_unit_row(const kacanov_operator& op, Each&& each) {
  const std::size_t dim = dimension(op.mesh.type);
  for (const std::int32_t node : op.unit_nodes)
    for (std::size_t c = 0; c < dim; ++c) each(node * dim + c);
  for (const std::int32_t unknown : op.constrained) each(static_cast<std::size_t>(unknown));
}

/// Returns `vectors` input vectors with zeros at constrained unknowns: x itself, or a copy in `room`.
template <class Real>
std::span<const Real> unconstrained(const kacanov_operator& op, std::span<const Real> x,
                                    std::vector<Real>& room) {
  const std::size_t n = op.unknowns();
  bool zero = true;
  for (std::size_t v = 0; v < x.size(); v += n)
    for (const std::int32_t i : op.constrained) zero = zero && x[v + i] == Real(0);
  if (zero) return x;
  room.assign(x.begin(), x.end());
  for (std::size_t v = 0; v < x.size(); v += n)
    for (const std::int32_t i : op.constrained) room[v + i] = Real(0);
  return room;
}

/// y += blocks · x; returns the contribution to xᵀ y.
template <class Real>
double add_blocks(const kacanov_operator& op, std::span<const Real> x, std::span<Real> y) {
  const std::size_t dim = dimension(op.mesh.type);
  double sum = 0.0;
  for (const NodeBlock& block : op.blocks) {
    const std::size_t at = static_cast<std::size_t>(block.node) * dim;
    for (std::size_t i = 0; i < dim; ++i) {
      double row = 0.0;
      for (std::size_t j = 0; j < dim; ++j) row += block.value[i * dim + j] * static_cast<double>(x[at + j]);
      y[at + i] += static_cast<Real>(row);
      sum += row * static_cast<double>(x[at + i]);
    }
  }
  return sum;
}

/// y = A x for one or more vectors; `product(x, y)` computes y = B x or B_T x and may return xᵀ y, for one
/// vector. Returns that value for all of A.
template <class Real, class Product>
double apply_rows(const kacanov_operator& op, std::span<const Real> x, std::span<Real> y,
                  const Product& product) {
  std::vector<Real> room;
  const auto in = unconstrained(op, x, room);
  double dot = product(in, y);
  const std::size_t n = op.unknowns();
  for (std::size_t v = 0; v < x.size(); v += n) {
    dot += add_blocks(op, in.subspan(v, n), y.subspan(v, n));
    each_unit_row(op, [&](std::size_t i) {
      // Replaces the contribution of product and blocks by that of the identity.
      dot += (static_cast<double>(x[v + i]) * static_cast<double>(x[v + i])) -
             static_cast<double>(in[v + i]) * static_cast<double>(y[v + i]);
      y[v + i] = x[v + i];
    });
  }
  return dot;
}

template <class Real>
void diagonal_rows(const kacanov_operator& op, std::span<Real> diagonal) {
  const std::size_t dim = dimension(op.mesh.type);
  for (const NodeBlock& block : op.blocks)
    for (std::size_t c = 0; c < dim; ++c)
      diagonal[static_cast<std::size_t>(block.node) * dim + c] += static_cast<Real>(block.value[c * dim + c]);
  each_unit_row(op, [&](std::size_t i) { diagonal[i] = Real(1); });
}

inline void block_rows(const kacanov_operator& op, std::span<double> blocks) {
  const std::size_t dim = dimension(op.mesh.type);
  for (const NodeBlock& block : op.blocks)
    for (std::size_t k = 0; k < dim * dim; ++k)
      blocks[static_cast<std::size_t>(block.node) * dim * dim + k] += block.value[k];
  each_unit_row(op, [&](std::size_t i) {
    const std::size_t node = i / dim;
    for (std::size_t j = 0; j < dim; ++j)
      blocks[i * dim + j] = blocks[(node * dim + j) * dim + i % dim] = 0.0;
    blocks[i * dim + i % dim] = 1.0;
  });
}

}  // namespace kacanov::c_api
