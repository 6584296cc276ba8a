// SPDX-License-Identifier: BSD-3-Clause
// Finds coincident boundary nodes that are not merged.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "problem/warnings.hpp"

namespace kacanov::validity {
namespace {

/// Nodes closer than these shares of the mesh size and of the shortest edge at a node coincide.
/// Single-precision files resolve coordinates to 1e-7.
constexpr double of_mesh = 1e-6, of_edge = 1e-2;
/// Reach relative to the cell width of the hash grid: few nodes are this close to another cell.
constexpr double cells_reach = 1.0 / 64;

/// Returns the distance within which another node coincides with a boundary node: a share of its shortest
/// edge, limited to `most`.
std::vector<double> reach_of_nodes(const Mesh& mesh, double most) {
  std::vector<double> reach(mesh.node_count(), most);
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    const auto facet = mesh.facet(f);
    for (const std::int32_t a : facet)
      for (const std::int32_t b : facet)
        if (a != b) reach[a] = std::min(reach[a], of_edge * norm(position(mesh, a) - position(mesh, b)));
  }
  return reach;
}

/// Boundary nodes, sorted by grid cell.
class NodeGrid {
 public:
  NodeGrid(const Mesh& mesh, const Extent& box)
      : mesh_(mesh), lower_(box.lower), reach_(of_mesh * box.size), width_(reach_ / cells_reach) {
    std::vector<std::int32_t> nodes = mesh.facets;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const std::int32_t node : nodes) {
      const Vector3 x = position(mesh, node);
      entries_.emplace_back(key(cell(x, 0.0)), node);
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls visit(node, other) for each node that coincides with a node of lower index; `other` is the lowest
  /// one.
  template <class Visit>
  void visit_repeated(const Visit& visit) const {
    const std::vector<double> reach = reach_of_nodes(mesh_, reach_);
    for (const auto& entry : entries_) {
      const std::int32_t node = entry.second;
      const Vector3 x = position(mesh_, node);
      const Cell low = cell(x, -reach_), high = cell(x, reach_);
      std::int32_t lowest = node;
      for (std::int64_t i = low[0]; i <= high[0]; ++i)
        for (std::int64_t j = low[1]; j <= high[1]; ++j)
          for (std::int64_t k = low[2]; k <= high[2]; ++k) {
            auto other = std::lower_bound(entries_.begin(), entries_.end(),
                                          std::pair{key({i, j, k}), std::int32_t{-1}});
            for (; other != entries_.end() && other->first == key({i, j, k}) && other->second < lowest;
                 ++other)
              if (norm(position(mesh_, other->second) - x) <= std::min(reach[node], reach[other->second]))
                lowest = other->second;
          }
      if (lowest != node) visit(node, lowest);
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(const Vector3& x, double shift) const {
    Cell at{};
    for (std::size_t c = 0; c < 3; ++c) at[c] = std::llround(std::floor((x[c] - lower_[c] + shift) / width_));
    return at;
  }
  /// There are fewer than 2²⁰ cells along each axis.
  static std::uint64_t key(const Cell& at) {
    std::uint64_t sum = 0;
    for (const std::int64_t one : at) sum = sum << 21 | static_cast<std::uint64_t>(one + 1);
    return sum;
  }

  const Mesh& mesh_;
  Vector3 lower_;
  double reach_, width_;
  std::vector<std::pair<std::uint64_t, std::int32_t>> entries_;
};

/// Count of pairs of coincident nodes, and the first pair.
struct Pairs {
  std::int64_t count = 0;
  std::int32_t first = 0, second = 0;

  void add(std::int32_t a, std::int32_t b) {
    if (count++ == 0 || std::pair{a, b} < std::pair{first, second}) first = a, second = b;
  }
  /// Returns "4 pairs of nodes lie at one place, the first nodes 5 and 9 at (0, 0, 1)".
  std::string text(const Mesh& mesh) const {
    return std::to_string(count) + (count == 1 ? " pair" : " pairs") + " of nodes " +
           (count == 1 ? "lies" : "lie") + " at one place, the first nodes " +
           std::to_string(mesh.node_tag(static_cast<std::size_t>(first))) + " and " +
           std::to_string(mesh.node_tag(static_cast<std::size_t>(second))) + " at " +
           to_text(position(mesh, first), mesh.dim());
  }
};

}  // namespace

void unmerged_nodes(const Problem& problem, Warnings& warnings) {
  const Mesh& mesh = problem.mesh;
  std::vector<std::pair<std::int32_t, std::int32_t>> repeated;
  NodeGrid(mesh, extent(mesh)).visit_repeated([&](std::int32_t node, std::int32_t lower) {
    repeated.emplace_back(lower, node);
  });
  if (repeated.empty()) return;
  const MeshPieces pieces = connected_pieces(mesh);
  Pairs between, within;
  for (const auto& [a, b] : repeated) (pieces.of_node[a] == pieces.of_node[b] ? within : between).add(a, b);
  if (between.count > 0)
    warnings.push_back(
        "the mesh is in " + std::to_string(pieces.count) + " pieces, and " + between.text(mesh) +
        ": nothing joins the pieces there; merge nodes at one place (in Gmsh: Coherence Mesh), "
        "unless they are bodies that may part and overlap");
  if (within.count > 0)
    warnings.push_back(
        "within one piece of the mesh " + within.text(mesh) +
        ": the body is slit there, and the sides of the slit may part and overlap; merge nodes at "
        "one place (in Gmsh: Coherence Mesh), unless a crack is meant");
}

}  // namespace kacanov::validity
