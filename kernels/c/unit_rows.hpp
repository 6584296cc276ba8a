// SPDX-License-Identifier: BSD-3-Clause
// Rows of the identity for nodes of no element, where the caller has asked for them.
#pragma once

#include <cstddef>

#include "c/handle.hpp"

namespace kacanov::c_api {

/// Calls each(i) for every unknown of these nodes.
template <class Each>
void each_unit_row(const kacanov_operator& op, Each&& each) {
  const std::size_t dim = dimension(op.mesh.type);
  for (const std::int32_t node : op.unit_nodes)
    for (std::size_t c = 0; c < dim; ++c) each(node * dim + c);
}

/// y = x there; returns their share of xᵀ y.
template <class Real>
double add_unit_rows(const kacanov_operator& op, std::span<const Real> x, std::span<Real> y) {
  double sum = 0.0;
  each_unit_row(op, [&](std::size_t i) {
    y[i] = x[i];
    sum += static_cast<double>(x[i]) * static_cast<double>(x[i]);
  });
  return sum;
}

template <class Real>
void unit_diagonal(const kacanov_operator& op, std::span<Real> diagonal) {
  each_unit_row(op, [&](std::size_t i) { diagonal[i] = Real(1); });
}

inline void unit_blocks(const kacanov_operator& op, std::span<double> blocks) {
  const std::size_t dim = dimension(op.mesh.type);
  each_unit_row(op, [&](std::size_t i) { blocks[i * dim + i % dim] = 1.0; });
}

}  // namespace kacanov::c_api
