// SPDX-License-Identifier: BSD-3-Clause
// The C interface's matrix: the plain assembly, with rows of the identity where they are asked for.
#include <kacanov/kacanov.h>

#include <algorithm>

#include "c/unit_rows.hpp"
#include "c/vectors.hpp"

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

std::size_t entries(kacanov_operator& op) {
  if (op.graph.first.empty()) op.graph = k::reference::node_graph(op.mesh);
  return static_cast<std::size_t>(k::reference::entries(op.graph, k::dimension(op.mesh.type)));
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
    require_size(n, op->unknowns(), "n");
    require_size(count, entries(*op), "entries");
    const auto at = u == nullptr ? std::span<const double>() : state(*op, n, u);
    std::vector<double> g(u == nullptr && value != nullptr ? op->body().secant_count() : 0);
    if (!g.empty()) fast.secant(g);
    const auto span = [](auto* data, std::size_t size) {
      return std::span(data, data == nullptr ? 0 : size);
    };
    const k::reference::MatrixRows rows{span(first, n + 1), span(column, count), span(value, count)};
    k::reference::assemble(op->body(), op->graph, g, at, rows);
    if (value == nullptr) return;
    const std::size_t dim = k::dimension(op->mesh.type);
    for (const std::int32_t node : op->unit_nodes)  // their rows have their own block and nothing else
      for (std::size_t c = 0; c < dim; ++c)
        value[static_cast<std::size_t>(op->graph.first[node]) * dim * dim + c * dim + c] = 1.0;
  });
}
