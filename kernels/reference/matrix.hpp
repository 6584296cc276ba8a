// SPDX-License-Identifier: BSD-3-Clause
// The operator as a matrix in compressed row storage, and element stiffness matrices in closed form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>

namespace kacanov::reference {

/// Nodes that share an element with a node, itself included: those of node i begin at first[i], ascending.
struct NodeGraph {
  std::vector<std::int64_t> first;  ///< nodes + 1
  std::vector<std::int32_t> neighbour;
};
NodeGraph node_graph(const MeshView& mesh);

/// Compressed row storage, one row per unknown, columns ascending. Empty spans are skipped.
struct MatrixRows {
  std::span<std::int64_t> first;   ///< unknowns + 1
  std::span<std::int32_t> column;  ///< entries(graph, dim)
  std::span<double> value;         ///< entries(graph, dim)
};
std::int64_t entries(const NodeGraph& graph, int dim);

/// Fills `rows` with B(g), or, if `u` is not empty, with the consistent tangent at u.
void assemble(const Body& body, const NodeGraph& graph, std::span<const double> g, std::span<const double> u,
              const MatrixRows& rows);

}  // namespace kacanov::reference

namespace kacanov {

/// The matrix of reference::element_matrix, computed block by block instead of column by column: K_ab = Σ
/// volume [(k0 − 2g/3) ∇φ_a ⊗ ∇φ_b + g ∇φ_b ⊗ ∇φ_a + g (∇φ_a·∇φ_b) I], with the element's average gradients
/// for k0 if the law has mean_dilatation. `g`: one value per point of the element. `matrix`: (nodes·dim)²
/// entries, row-major, the components of a node contiguous.
void element_stiffness(const Body& body, std::size_t element, std::span<const double> g,
                       std::span<double> matrix);

}  // namespace kacanov
