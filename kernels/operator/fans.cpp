// SPDX-License-Identifier: BSD-3-Clause
// Greedy cover: edges in the order of the tetrahedra left round them, by a bucket queue.
#include "operator/fans.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "cells/tet10.hpp"

namespace kacanov {
namespace {

using Index = std::int32_t;

/// Local edges of a tetrahedron (p, q), and the other two nodes so that (p, q, a, b) is oriented like it.
constexpr std::array<std::array<std::uint8_t, 4>, 6> edges{
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

/// Edges of the mesh and the tetrahedra round each, as 8 × element + local edge.
struct EdgeTable {
  std::vector<std::uint32_t> first;  ///< of edge i in `around`; one more entry than edges
  std::vector<std::uint32_t> around;

  std::size_t size() const { return first.size() - 1; }
  std::span<const std::uint32_t> of(std::uint32_t edge) const {
    return std::span(around).subspan(first[edge], first[edge + 1] - first[edge]);
  }
};

const Index* nodes_of(const MeshView& mesh, std::size_t element) {
  return mesh.connectivity.data() + element * nodes_per_element(mesh.type);
}

EdgeTable make_edges(const MeshView& mesh) {
  struct Entry {
    Index high;
    std::uint32_t place;
  };
  std::vector<std::uint32_t> start(mesh.node_count() + 1, 0);
  const std::size_t count = mesh.element_count();
  for (std::size_t e = 0; e < count; ++e)
    for (const auto& edge : edges) {
      const Index* node = nodes_of(mesh, e);
      ++start[at(std::min(node[edge[0]], node[edge[1]])) + 1];
    }
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<Entry> entries(6 * count);
  std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
  for (std::size_t e = 0; e < count; ++e)
    for (std::uint32_t k = 0; k < 6; ++k) {
      const Index* node = nodes_of(mesh, e);
      const auto [low, high] = std::minmax(node[edges[k][0]], node[edges[k][1]]);
      entries[fill[low]++] = {high, static_cast<std::uint32_t>(8 * e) + k};
    }
  EdgeTable table;
  table.around.reserve(entries.size());
  for (std::size_t i = 0; i + 1 < start.size(); ++i) {
    const auto from = entries.begin() + start[i], to = entries.begin() + start[i + 1];
    std::sort(from, to, [](const Entry& a, const Entry& b) {
      return a.high != b.high ? a.high < b.high : a.place < b.place;
    });
    for (auto it = from; it != to; ++it) {
      if (it == from || it->high != (it - 1)->high)
        table.first.push_back(static_cast<std::uint32_t>(table.around.size()));
      table.around.push_back(it->place);
    }
  }
  table.first.push_back(static_cast<std::uint32_t>(table.around.size()));
  return table;
}

/// Edges that are the longest of every tetrahedron round them. Taken first among equals they keep a cover
/// regular: in a box cut along its diagonals the diagonals' fans of six tile it.
std::vector<bool> longest_of_all(const MeshView& mesh, const EdgeTable& table) {
  const auto square = [&](const Index* t, std::size_t k) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d =
          mesh.coordinates[3 * at(t[edges[k][0]]) + c] - mesh.coordinates[3 * at(t[edges[k][1]]) + c];
      sum += d * d;
    }
    return sum;
  };
  std::vector<std::uint8_t> longest(mesh.element_count());
  for (std::size_t e = 0; e < longest.size(); ++e) {
    double best = -1.0;
    for (std::size_t k = 0; k < 6; ++k)
      if (const double s = square(nodes_of(mesh, e), k); s > best) {
        best = s;
        longest[e] = static_cast<std::uint8_t>(k);
      }
  }
  std::vector<bool> result(table.size());
  for (std::uint32_t i = 0; i < result.size(); ++i) {
    const auto around = table.of(i);
    result[i] = std::all_of(around.begin(), around.end(),
                            [&](std::uint32_t place) { return longest[place / 8] == place % 8; });
  }
  return result;
}

struct Cover {
  const MeshView& mesh;
  Units result;

  /// One tetrahedron round the edge, as the arc from ring node `a` to ring node `b`.
  struct Arc {
    Index a, b, element;
    std::uint16_t law;
    bool used;
  };
  std::vector<Arc> arcs;

  void add_fan(bool closed, Index p, Index q, std::span<const Arc> chain) {
    constexpr std::size_t longest = simd::longest_fan;
    if (chain.size() > longest) {
      add_fan(false, p, q, chain.first(longest));
      add_fan(false, p, q, chain.subspan(longest));
      return;
    }
    result.units.push_back({closed ? simd::Shape::closed_fan : simd::Shape::open_fan,
                            static_cast<std::uint8_t>(chain.size()), chain[0].law,
                            static_cast<std::uint32_t>(result.nodes.size()),
                            static_cast<std::uint32_t>(result.elements.size())});
    for (const Arc& arc : chain) result.elements.push_back(arc.element);
    if (mesh.type == ElementType::tet10) return add_quadratic_nodes(p, q, chain);
    result.nodes.insert(result.nodes.end(), {p, q, chain[0].a});
    for (const Arc& arc : chain)
      if (!closed || &arc != &chain.back()) result.nodes.push_back(arc.b);
  }

  Index middle(Index element, Index a, Index b) const {
    const Index* node = nodes_of(mesh, at(element));
    for (const CellEdge& edge : elements::Tet10::edge)
      if (std::minmax(node[edge.a], node[edge.b]) == std::minmax(a, b)) return node[edge.middle];
    return -1;
  }

  void add_quadratic_nodes(Index p, Index q, std::span<const Arc> chain) {
    const auto add_corner = [&](Index element, Index r) {
      result.nodes.insert(result.nodes.end(), {r, middle(element, p, r), middle(element, q, r)});
    };
    result.nodes.insert(result.nodes.end(), {p, q, middle(chain[0].element, p, q)});
    add_corner(chain[0].element, chain[0].a);
    for (const Arc& arc : chain) {
      result.nodes.push_back(middle(arc.element, arc.a, arc.b));
      add_corner(arc.element, arc.b);
    }
  }

  /// Splits the arcs round (p, q) into chains of one law, longest possible, and adds them.
  void split(Index p, Index q) {
    std::vector<Arc> chain;
    const auto follow = [&](Index from, std::uint16_t law_index) -> Arc* {
      for (Arc& arc : arcs)
        if (!arc.used && arc.a == from && arc.law == law_index) return &arc;
      return nullptr;
    };
    const auto has_one_before = [&](const Arc& arc) {
      return std::any_of(arcs.begin(), arcs.end(), [&](const Arc& other) {
        return !other.used && &other != &arc && other.b == arc.a && other.law == arc.law;
      });
    };
    for (const bool rings : {false, true})  // chains with a beginning first; what remains are rings
      for (Arc& arc : arcs) {
        if (arc.used || (!rings && has_one_before(arc))) continue;
        chain.clear();
        for (Arc* next = &arc; next != nullptr; next = follow(next->b, next->law)) {
          next->used = true;
          chain.push_back(*next);
        }
        const bool closed =
            rings && mesh.type == ElementType::tet4 && chain.size() >= 3 && chain.back().b == chain.front().a;
        add_fan(closed, p, q, chain);
      }
  }
};

}  // namespace

Units cover_by_fans(const Body& body, std::vector<bool> taken) {
  const MeshView& mesh = body.mesh;
  const EdgeTable table = make_edges(mesh);
  const std::vector<bool> preferred = longest_of_all(mesh, table);
  Cover cover{mesh, {}, {}};
  const auto left_of = [&](std::uint32_t edge) {
    std::uint32_t left = 0;
    for (const std::uint32_t place : table.of(edge)) left += taken[place / 8] ? 0 : 1;
    return left;
  };
  std::vector<std::vector<std::uint32_t>> queue;
  const auto enqueue = [&](std::uint32_t edge, std::uint32_t left) {
    const std::size_t bucket = 2 * std::size_t{left} + (preferred[edge] ? 1 : 0);
    if (queue.size() <= bucket) queue.resize(bucket + 1);
    queue[bucket].push_back(edge);
  };
  for (std::uint32_t edge = 0; edge < table.size(); ++edge)
    enqueue(edge, static_cast<std::uint32_t>(table.of(edge).size()));
  // Counts only fall, so an edge found in too high a bucket goes down to the one where it belongs.
  for (std::size_t bucket = queue.size(); bucket-- > 2;) {
    for (std::size_t i = 0; i < queue[bucket].size(); ++i) {
      const std::uint32_t edge = queue[bucket][i];
      const std::uint32_t left = left_of(edge);
      if (left < bucket / 2) {
        if (left > 0) enqueue(edge, left);
        continue;
      }
      const std::uint32_t first = table.of(edge)[0];
      const Index low = std::min(nodes_of(mesh, first / 8)[edges[first % 8][0]],
                                 nodes_of(mesh, first / 8)[edges[first % 8][1]]);
      Index p = 0, q = 0;
      cover.arcs.clear();
      for (const std::uint32_t place : table.of(edge)) {
        const std::uint32_t e = place / 8;
        if (taken[e]) continue;
        taken[e] = true;
        const Index* t = nodes_of(mesh, e);
        const auto& local = edges[place % 8];
        const bool forward = t[local[0]] == low;
        p = low, q = forward ? t[local[1]] : t[local[0]];
        const Index a = t[local[forward ? 2 : 3]], b = t[local[forward ? 3 : 2]];
        cover.arcs.push_back({a, b, static_cast<Index>(e), body.law_index(e), false});
      }
      cover.split(p, q);
    }
    queue[bucket] = {};
  }
  return std::move(cover.result);
}

}  // namespace kacanov
