// SPDX-License-Identifier: BSD-3-Clause
// Connected components of a mesh.
#include "mesh/pieces.hpp"

#include <cstddef>
#include <numeric>

namespace kacanov {
namespace {

std::int32_t find_root(std::vector<std::int32_t>& parent, std::int32_t node) {
  while (parent[node] != node) {
    std::int32_t& up = parent[node];
    up = parent[up];
    node = up;
  }
  return node;
}

}  // namespace

MeshPieces connected_pieces(const Mesh& mesh) {
  std::vector<std::int32_t> parent(mesh.node_count());
  std::iota(parent.begin(), parent.end(), 0);
  const std::size_t n = nodes_per_element(mesh.type);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::int32_t first = find_root(parent, mesh.elements[e * n]);
    for (std::size_t k = 1; k < n; ++k) parent[find_root(parent, mesh.elements[e * n + k])] = first;
  }
  MeshPieces pieces{0, std::vector<std::int32_t>(mesh.node_count(), -1)};
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    std::int32_t& piece = pieces.of_node[find_root(parent, mesh.elements[e * n])];
    if (piece < 0) piece = pieces.count++;
  }
  for (std::size_t node = 0; node < parent.size(); ++node)
    pieces.of_node[node] = pieces.of_node[find_root(parent, static_cast<std::int32_t>(node))];
  return pieces;
}

}  // namespace kacanov
