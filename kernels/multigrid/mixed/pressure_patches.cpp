// SPDX-License-Identifier: BSD-3-Clause
// Node patches over which linear tetrahedra average their volume change.
#include <kacanov/pressure_patches.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include <kacanov/corner_means.hpp>
#include <kacanov/vector3.hpp>
#include "multigrid/octree/octree.hpp"
#include "parallel/disjoint_sets.hpp"
#include "parallel/exchange.hpp"

namespace kacanov {
namespace {

/// Edge of a cube over the node spacing: with 2 tet4 is stiffer, with 4 its pressures are coarse.
constexpr double patch_width = 2.6;
/// Minimum number of nodes of a patch. A cube of a regular mesh has 8 to 27, fewer at the surface. The
/// inf-sup constant decreases with patches of one to three nodes along edges and at corners.
constexpr std::int64_t least_nodes = 4;

/// The head of a patch, its node nearest to the centre of its cube, whose number names it; `off`: squared
/// distance from that centre, or from a node to the head it may follow. Ties must not depend on numbering.
struct Head {
  double off;
  Vector3 at;
  std::int64_t node;
  bool operator<(const Head& other) const { return std::tie(off, at) < std::tie(other.off, other.at); }
};

/// Number of nodes of a patch on some rank.
struct Count {
  std::int64_t node, count;
};

class PatchMaker {
 public:
  PatchMaker(const Body& body, const IndexMap& nodes) : body_(body), nodes_(nodes) {
    const std::span<const double> x = body.mesh.coordinates;
    const Octree tree({x, node_spacings(body, nodes), static_cast<std::size_t>(nodes.owned)}, patch_width,
                      nodes);
    for (std::size_t n = 0; n < body.mesh.node_count(); ++n) {
      cube_.push_back(tree.leaf_of(&x[3 * n], 0));
      double off = 0.0;
      for (const double xi : tree.within(tree.cells()[cube_[n]], &x[3 * n])) off += (xi - 0.5) * (xi - 0.5);
      constexpr double grain = 1e6;  // rounding errors must not decide
      head_.push_back({std::round(grain * off) / grain, position(n), nodes.number(n)});
    }
  }

  std::vector<std::int64_t> run() {
    find_pieces();
    do {
      tell_pieces();
    } while (nodes_.any(tell_ranks(head_)));
    join_small_ones();
    std::vector<std::int64_t> patch;
    patch.reserve(head_.size());
    for (const Head& head : head_) patch.push_back(head.node);
    return patch;
  }

 private:
  Vector3 position(std::size_t node) const {
    const double* x = &body_.mesh.coordinates[3 * node];
    return {x[0], x[1], x[2]};
  }

  /// Calls visit(a, b) for the edges of elements that average.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (std::size_t e = 0; e < body_.mesh.element_count(); ++e) {
      if (!averages_at_corners(body_.law(e), body_.mesh.type)) continue;
      const std::int32_t* node = &body_.mesh.connectivity[4 * e];
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b)
          visit(static_cast<std::size_t>(node[a]), static_cast<std::size_t>(node[b]));
    }
  }

  /// Connected pieces of this rank's nodes within a cube: all nodes of a piece follow the same head.
  void find_pieces() {
    DisjointSets sets(head_.size());
    for_each_edge([&](std::size_t a, std::size_t b) {
      if (cube_[a] == cube_[b]) sets.join(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
    });
    piece_.resize(head_.size());
    for (std::size_t n = 0; n < piece_.size(); ++n) piece_[n] = sets.find(static_cast<std::int32_t>(n));
  }

  /// Gives each piece the best head of its nodes.
  void tell_pieces() {
    for (std::size_t n = 0; n < head_.size(); ++n)
      if (head_[n] < head_[piece_[n]]) head_[piece_[n]] = head_[n];
    for (std::size_t n = 0; n < head_.size(); ++n) head_[n] = head_[piece_[n]];
  }

  /// Takes the minimum over all ranks at every node; returns whether a head of this rank has changed.
  bool tell_ranks(std::vector<Head>& heads) const {
    if (nodes_.ranks == 1) return false;
    std::vector<std::vector<Head>> to(nodes_.ranks);
    for (const IndexMap::Neighbour& n : nodes_.neighbours)
      for (const std::int32_t i : n.shared) to[n.rank].push_back(heads[i]);
    const Received<Head> told = exchange_all(to, nodes_);
    bool news = false;
    for (const IndexMap::Neighbour& n : nodes_.neighbours) {
      const std::span<const Head> from = told.from(n.rank);
      for (std::size_t k = 0; k < from.size(); ++k)
        if (Head& head = heads[n.shared[k]]; from[k] < head) head = from[k], news = true;
    }
    return news;
  }

  /// Number of nodes in each node's patch.
  std::vector<std::int64_t> sizes() const {
    std::vector<std::int64_t> size(head_.size(), 0);  // first per piece, finally per node
    for (std::size_t n = 0; n < static_cast<std::size_t>(nodes_.owned); ++n) ++size[piece_[n]];
    std::map<std::int64_t, std::int64_t> here;
    for (std::size_t n = 0; n < head_.size(); ++n)
      if (piece_[n] == n) here[head_[n].node] += size[n];
    std::vector<std::vector<Count>> to(nodes_.ranks);
    for (const auto& [node, count] : here) to[nodes_.owner(node)].push_back({node, count});
    const Received<Count> told = exchange_all(to, nodes_);
    std::map<std::int64_t, std::int64_t> all;
    for (const Count& one : told.entries) all[one.node] += one.count;
    std::vector<std::vector<Count>> back(nodes_.ranks);
    for (std::size_t r = 0; r < back.size(); ++r)
      for (const Count& one : told.from(r)) back[r].push_back({one.node, all.at(one.node)});
    for (const Count& one : exchange_all(back, nodes_).entries) here[one.node] = one.count;
    for (std::size_t n = 0; n < head_.size(); ++n)
      size[n] = piece_[n] == n ? here.at(head_[n].node) : size[piece_[n]];
    return size;
  }

  /// Nodes of small patches follow the nearest head of a neighbour, if there is one.
  void join_small_ones() {
    const std::vector<std::int64_t> size = sizes();
    std::vector<char> settled(head_.size());
    for (std::size_t n = 0; n < head_.size(); ++n) settled[n] = size[n] >= least_nodes;
    std::vector<std::pair<std::size_t, std::size_t>> ways;  // to nodes that are not settled: few
    for_each_edge([&](std::size_t a, std::size_t b) {
      if (!settled[b]) ways.emplace_back(a, b);
      if (!settled[a]) ways.emplace_back(b, a);
    });
    constexpr double nowhere = std::numeric_limits<double>::infinity();
    for (bool more = true; nodes_.any(more);) {
      std::vector<Head> best(head_.size(), {nowhere, {}, 0});
      for (const auto& [a, b] : ways) {
        if (!settled[a] || settled[b]) continue;
        const Vector3 here = position(b);
        double off = 0.0;
        for (std::size_t k = 0; k < 3; ++k) off += (here[k] - head_[a].at[k]) * (here[k] - head_[a].at[k]);
        best[b] = std::min(best[b], Head{off, head_[a].at, head_[a].node});
      }
      tell_ranks(best);
      more = false;
      for (std::size_t n = 0; n < head_.size(); ++n) {
        if (settled[n] || best[n].off == nowhere) continue;
        head_[n] = best[n];
        settled[n] = 1;
        more = true;
      }
    }
  }

  const Body& body_;
  const IndexMap& nodes_;
  std::vector<std::int32_t> cube_;  ///< per node
  std::vector<std::size_t> piece_;  ///< per node: first node of its piece
  std::vector<Head> head_;          ///< per node: best head found in its patch
};

}  // namespace

std::vector<std::int64_t> pressure_patches(const Body& body, const IndexMap& nodes) {
  if (body.mesh.type != ElementType::tet4 || corner_moduli(body).empty()) return {};
  return PatchMaker(body, nodes).run();
}

}  // namespace kacanov
