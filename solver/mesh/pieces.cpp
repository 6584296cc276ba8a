// SPDX-License-Identifier: BSD-3-Clause
// Connected components of a mesh.
#include "mesh/pieces.hpp"

#include <cstddef>

#include "parallel/disjoint_sets.hpp"

namespace kacanov {

MeshPieces connected_pieces(const Mesh& mesh) {
  DisjointSets sets(mesh.node_count());
  const std::size_t n = nodes_per_element(mesh.type);
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t k = 1; k < n; ++k) sets.join(mesh.elements[e * n], mesh.elements[e * n + k]);
  MeshPieces pieces{0, std::vector<std::int32_t>(mesh.node_count(), -1)};
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    std::int32_t& piece = pieces.of_node[sets.find(mesh.elements[e * n])];
    if (piece < 0) piece = pieces.count++;
  }
  for (std::size_t node = 0; node < pieces.of_node.size(); ++node)
    pieces.of_node[node] = pieces.of_node[sets.find(static_cast<std::int32_t>(node))];
  return pieces;
}

}  // namespace kacanov
