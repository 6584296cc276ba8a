// SPDX-License-Identifier: BSD-3-Clause
// The patches of nodes over which linear tetrahedra average their volume change.
#include <kacanov/pressure_patches.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>

#include <kacanov/corner_means.hpp>
#include <kacanov/vector3.hpp>
#include "distributed/exchange.hpp"
#include "multigrid/grid_tree.hpp"
#include "multigrid/node_spacing.hpp"

namespace kacanov {
namespace {

/// Edge of a cube over the distance of nodes: with 2 tet4 is stiffer, with 4 its pressures are coarse.
constexpr double patch_width = 2.6;
/// Nodes of a patch: a cube of a regular mesh has 8 to 27 of them, less where it is cut by the surface. The
/// inf-sup constant falls with patches of one to three nodes along edges and at corners.
constexpr std::int64_t least_nodes = 4;

/// The node a patch is named after, the one nearest to the middle of its cube, and how far off that is,
/// squared; or how far a node is from the head it might follow. Ties must not depend on numbers.
struct Head {
  double off;
  Vector3 at;
  std::int64_t node;
  bool operator<(const Head& other) const { return std::tie(off, at) < std::tie(other.off, other.at); }
};

/// How many nodes a patch has, as some rank knows.
struct Count {
  std::int64_t node, count;
};

class PatchMaker {
 public:
  PatchMaker(const Body& body, const IndexMap& nodes) : body_(body), nodes_(nodes) {
    const std::span<const double> x = body.mesh.coordinates;
    const GridTree tree({x, node_spacings(body, nodes), static_cast<std::size_t>(nodes.owned)}, patch_width,
                        nodes);
    for (std::size_t n = 0; n < body.mesh.node_count(); ++n) {
      cube_.push_back(tree.leaf_of(&x[3 * n], 0));
      double off = 0.0;
      for (const double xi : tree.within(tree.cells()[cube_[n]], &x[3 * n])) off += (xi - 0.5) * (xi - 0.5);
      constexpr double grain = 1e6;  // rounding must not decide
      head_.push_back({std::round(grain * off) / grain, position(n), nodes.number(n)});
    }
  }

  std::vector<std::int64_t> run() {
    do {
      while (tell_neighbours()) {
      }
    } while (nodes_.any(tell_ranks(head_)));
    join_small_ones();
    std::vector<std::int64_t> patch;
    for (const Head& head : head_) patch.push_back(head.node);
    return patch;
  }

 private:
  Vector3 position(std::size_t node) const {
    const double* x = &body_.mesh.coordinates[3 * node];
    return {x[0], x[1], x[2]};
  }

  /// Calls visit(a, b) for the edges of elements that average, both ways round.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (std::size_t e = 0; e < body_.mesh.element_count(); ++e) {
      if (!averages_at_corners(body_.law(e), body_.mesh.type)) continue;
      const std::int32_t* node = &body_.mesh.connectivity[4 * e];
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
          if (a != b) visit(static_cast<std::size_t>(node[a]), static_cast<std::size_t>(node[b]));
    }
  }

  /// Of the best head known; whether somebody in the same cube has learned something.
  bool tell_neighbours() {
    bool news = false;
    for_each_edge([&](std::size_t a, std::size_t b) {
      if (cube_[a] == cube_[b] && head_[a] < head_[b]) head_[b] = head_[a], news = true;
    });
    return news;
  }

  /// The least of all ranks at every node; whether this one learns something.
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

  /// Nodes of each node's patch.
  std::vector<std::int64_t> sizes() const {
    std::map<std::int64_t, std::int64_t> here;
    for (std::size_t n = 0; n < head_.size(); ++n)
      here[head_[n].node] += n < static_cast<std::size_t>(nodes_.owned) ? 1 : 0;
    std::vector<std::vector<Count>> to(nodes_.ranks);
    for (const auto& [node, count] : here) to[nodes_.owner(node)].push_back({node, count});
    const Received<Count> told = exchange_all(to, nodes_);
    std::map<std::int64_t, std::int64_t> all;
    for (const Count& one : told.entries) all[one.node] += one.count;
    std::vector<std::vector<Count>> back(nodes_.ranks);
    for (std::size_t r = 0; r < back.size(); ++r)
      for (const Count& one : told.from(r)) back[r].push_back({one.node, all.at(one.node)});
    for (const Count& one : exchange_all(back, nodes_).entries) here[one.node] = one.count;
    std::vector<std::int64_t> size;
    for (const Head& head : head_) size.push_back(here.at(head.node));
    return size;
  }

  /// Nodes of small patches follow the nearest head of a neighbour, if they have one.
  void join_small_ones() {
    const std::vector<std::int64_t> size = sizes();
    std::vector<char> settled(head_.size());
    for (std::size_t n = 0; n < head_.size(); ++n) settled[n] = size[n] >= least_nodes;
    constexpr double nowhere = std::numeric_limits<double>::infinity();
    for (bool more = true; nodes_.any(more);) {
      std::vector<Head> best(head_.size(), {nowhere, {}, 0});
      for_each_edge([&](std::size_t a, std::size_t b) {
        if (!settled[a] || settled[b]) return;
        const Vector3 here = position(b);
        double off = 0.0;
        for (std::size_t k = 0; k < 3; ++k) off += (here[k] - head_[a].at[k]) * (here[k] - head_[a].at[k]);
        best[b] = std::min(best[b], Head{off, head_[a].at, head_[a].node});
      });
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
  std::vector<std::int32_t> cube_;  ///< of a node
  std::vector<Head> head_;          ///< the best known in its patch
};

}  // namespace

std::vector<std::int64_t> pressure_patches(const Body& body, const IndexMap& nodes) {
  if (body.mesh.type != ElementType::tet4 || corner_moduli(body).empty()) return {};
  return PatchMaker(body, nodes).run();
}

}  // namespace kacanov
