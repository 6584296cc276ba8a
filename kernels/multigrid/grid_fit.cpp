// SPDX-License-Identifier: BSD-3-Clause
// Criteria for the fit of a background grid to a body.
#include "multigrid/grid_fit.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "parallel/disjoint_sets.hpp"
#include "parallel/exchange.hpp"

namespace kacanov {
namespace {

using Pair = std::array<std::int32_t, 2>;

/// Connected sets of a rank's nodes within one leaf, and the pairs of them that elements or common nodes
/// connect across leaves and ranks; gathered from all ranks, the same on each.
struct Fragments {
  std::vector<std::int32_t> leaf;
  std::vector<double> nodes;
  std::vector<Pair> joined;  ///< both directions, ascending
};

Fragments fragments_of(std::span<const std::int32_t> cell, const MultigridBody& body) {
  const IndexMap& map = *body.node_map;
  const MeshView& mesh = body.body.mesh;
  const std::size_t npe = nodes_per_element(mesh.type);
  const auto node_of = [&](std::size_t e, std::size_t a) { return mesh.connectivity[e * npe + a]; };
  DisjointSets sets(cell.size());
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t a = 1; a < npe; ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (cell[node_of(e, a)] == cell[node_of(e, b)]) {
          sets.join(node_of(e, a), node_of(e, b));
          break;
        }
  std::vector<std::int32_t> fragment(cell.size());
  std::vector<std::int32_t> leaf;
  std::vector<double> nodes;
  for (std::size_t n = 0; n < cell.size(); ++n) {
    const auto root = static_cast<std::size_t>(sets.find(static_cast<std::int32_t>(n)));
    if (root == n) {
      fragment[n] = static_cast<std::int32_t>(leaf.size());
      leaf.push_back(cell[n]), nodes.push_back(0.0);
    }
    fragment[n] = fragment[root];  // roots have the lowest numbers
    if (n < body.owned_nodes()) nodes[fragment[n]] += 1.0;
  }
  const auto first = static_cast<std::int32_t>(map.sum_below(static_cast<std::int64_t>(leaf.size())));
  for (std::int32_t& f : fragment) f += first;
  std::vector<Pair> joined;
  std::vector<Pair> lately(1024, Pair{-1, -1});  // cache of recent pairs: most repeat many times
  const auto join = [&](std::int32_t f, std::int32_t g) {
    const Pair pair{std::min(f, g), std::max(f, g)};
    Pair& same =
        lately[(31 * static_cast<std::size_t>(pair[0]) + static_cast<std::size_t>(pair[1])) % lately.size()];
    if (f == g || same == pair) return;
    joined.push_back(pair);
    same = pair;
  };
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t a = 1; a < npe; ++a)
      for (std::size_t b = 0; b < a; ++b) join(fragment[node_of(e, a)], fragment[node_of(e, b)]);
  std::vector<std::int32_t> owners = fragment;
  map.forward(owners, 1);
  for (std::size_t n = body.owned_nodes(); n < cell.size(); ++n) join(fragment[n], owners[n]);
  std::sort(joined.begin(), joined.end());
  joined.erase(std::unique(joined.begin(), joined.end()), joined.end());

  Fragments all{gathered(leaf, map), gathered(nodes, map), gathered(joined, map)};
  const std::size_t one_way = all.joined.size();
  for (std::size_t i = 0; i < one_way; ++i) all.joined.push_back({all.joined[i][1], all.joined[i][0]});
  std::sort(all.joined.begin(), all.joined.end());
  return all;
}

/// Number of nodes of a function with these fragments, and number of those outside its largest piece.
std::array<double, 2> pieces(const Fragments& fragments, std::span<const std::int32_t> of) {
  DisjointSets sets(of.size());
  for (std::size_t i = 0; i < of.size(); ++i) {
    const auto begin = std::lower_bound(fragments.joined.begin(), fragments.joined.end(), Pair{of[i], 0});
    for (auto at = begin; at != fragments.joined.end() && (*at)[0] == of[i]; ++at) {
      const auto other = std::lower_bound(of.begin(), of.end(), (*at)[1]);
      if (other != of.end() && *other == (*at)[1])
        sets.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(other - of.begin()));
    }
  }
  std::vector<double> nodes(of.size(), 0.0);
  double total = 0.0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    nodes[sets.find(static_cast<std::int32_t>(i))] += fragments.nodes[of[i]];
    total += fragments.nodes[of[i]];
  }
  return {total, total - *std::max_element(nodes.begin(), nodes.end())};
}

/// Whether a function moves nodes of both leaves.
bool share_rows(const GridVertices& vertices, std::int32_t a, std::int32_t b) {
  for (std::size_t i = 0; i < 8; ++i)
    for (const auto& one : vertices.corner(a, i))
      for (std::size_t j = 0; j < 8; ++j)
        for (const auto& other : vertices.corner(b, j))
          if (one.row == other.row) return true;
  return false;
}

/// A slot along a bar has 0.09 to 0.12, and 2 to 4 times the iterations of aggregates; a hook with its gap
/// has 0.013, and half the iterations.
constexpr double most_cut_off = 0.03;
/// Beyond this, elements are more than about seven times as long as wide, and cubes between their nodes are
/// empty.
constexpr double most_apart = 0.01;

}  // namespace

bool GridFit::pays() const noexcept { return cut_off <= most_cut_off && apart <= most_apart; }

GridFit grid_fit(const GridVertices& vertices, std::span<const std::int32_t> cell,
                 const MultigridBody& body) {
  const IndexMap& map = *body.node_map;
  const Fragments fragments = fragments_of(cell, body);
  const std::int64_t begin = vertices.starts()[map.rank], end = vertices.starts()[map.rank + 1];
  std::vector<std::vector<std::int32_t>> of_row(end - begin);
  for (std::size_t f = 0; f < fragments.leaf.size(); ++f)
    for (std::size_t k = 0; k < 8; ++k)
      for (const GridVertices::Share& share : vertices.corner(fragments.leaf[f], k)) {
        if (share.row < begin || share.row >= end) continue;
        auto& list = of_row[share.row - begin];
        if (list.empty() || list.back() != static_cast<std::int32_t>(f))
          list.push_back(static_cast<std::int32_t>(f));
      }
  std::array<double, 2> sums{};
  for (const auto& list : of_row) {
    if (list.empty()) continue;
    const auto row = pieces(fragments, list);
    sums[0] += row[0], sums[1] += row[1];
  }
  map.sum_all(sums);
  double apart = 0.0;
  for (const auto& [f, g] : fragments.joined)
    if (f < g && !share_rows(vertices, fragments.leaf[f], fragments.leaf[g])) apart += 2.0;
  const auto joined = static_cast<double>(fragments.joined.size());
  return {sums[0] > 0.0 ? sums[1] / sums[0] : 0.0, joined > 0.0 ? apart / joined : 0.0};
}

}  // namespace kacanov
