// SPDX-License-Identifier: BSD-3-Clause
// The C interface's matrix: plain assembly, with node blocks and rows of the identity.
#include <kacanov/kacanov.h>

#include <algorithm>
#include <vector>

#include "c/laws.hpp"
#include "c/rows.hpp"
#include "c/vectors.hpp"

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

std::size_t entries(kacanov_operator& op) {
  if (op.graph.first.empty()) op.graph = k::reference::node_graph(op.mesh);
  return static_cast<std::size_t>(k::reference::entries(op.graph, k::dimension(op.mesh.type)));
}

/// Adds the node blocks to the values, and sets rows and columns of the identity.
void matrix_rows(const kacanov_operator& op, std::span<double> value) {
  const std::size_t dim = k::dimension(op.mesh.type);
  const auto& [first, neighbour] = op.graph;
  std::vector<double> diagonal(op.unknowns() * dim, 0.0);
  block_rows(op, diagonal);  // added blocks, and ones
  std::vector<char> unit(op.unknowns(), 0);
  each_unit_row(op, [&](std::size_t i) { unit[i] = 1; });
  for (std::size_t node = 0; node + 1 < first.size(); ++node) {
    const std::size_t begin = first[node], count = static_cast<std::size_t>(first[node + 1]) - begin;
    for (std::size_t c = 0; c < dim; ++c)
      for (std::size_t k = 0; k < count; ++k)
        for (std::size_t d = 0; d < dim; ++d) {
          const std::size_t other = neighbour[begin + k], row = node * dim + c, column = other * dim + d;
          double& entry = value[begin * dim * dim + (c * count + k) * dim + d];
          if (unit[row] != 0 || unit[column] != 0) entry = 0.0;
          if (node == other) entry += diagonal[row * dim + d];
        }
  }
}

}  // namespace

int kacanov_matrix_entries(kacanov_operator* op, size_t n, size_t* count) {
  return on(op, [&](k::Operator&) {
    require_size(n, op->unknowns(), "n");
    require(count, "entries");
    *count = entries(*op);
  });
}

int kacanov_matrix(kacanov_operator* op, size_t n, const double* u, size_t count, int64_t* first,
                   int32_t* column, double* value) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_size(n, op->unknowns(), "n");
    require_size(count, entries(*op), "entries");
    const auto at = u == nullptr ? std::span<const double>() : call.state(n, u);
    std::vector<double> g(u == nullptr && value != nullptr ? op->body().secant_count() : 0);
    if (!g.empty()) fast.secant(g);
    const auto span = [](auto* data, std::size_t size) {
      return std::span(data, data == nullptr ? 0 : size);
    };
    const k::reference::MatrixRows rows{span(first, n + 1), span(column, count), span(value, count)};
    k::Body body = op->body();
    PointValues values;
    k::PointModuli moduli;
    if (!at.empty() && value != nullptr && op->has_own_laws()) {
      values = ask_laws(*op, at, {.derivative = true});
      moduli = values.moduli();
      body.moduli = &moduli;
    }
    k::reference::assemble(body, op->graph, g, at, rows);
    if (value == nullptr) return;
    matrix_rows(*op, rows.value);
  });
}
