// SPDX-License-Identifier: BSD-3-Clause
// Covers a body by work items: the greedy cover of a tetrahedral mesh by fans, or one element each.
#include "operator/work_items.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "cells/elements.hpp"
#include "cells/straight.hpp"

namespace kacanov {
namespace {

/// Whether a hex8 is a parallelepiped: each edge equals the first corner's edge in its direction, up to
/// rounding of the element's extent along each axis.
bool parallelepiped(const MeshView& mesh, const std::int32_t* node) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 8> x;
    for (std::size_t a = 0; a < 8; ++a) x[a] = mesh.coordinates[3 * static_cast<std::size_t>(node[a]) + k];
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    const double rounding =
        4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(*low), std::abs(*high));
    const double along[3] = {x[1] - x[0], x[3] - x[0], x[4] - x[0]};
    for (std::size_t a = 0; a < 8; ++a) {
      double off = x[a] - x[0];
      for (std::size_t direction = 0; direction < 3; ++direction)
        if (elements::Hex8::corner[a][direction] > 0) off -= along[direction];
      if (std::abs(off) > 1e-13 * (*high - *low) + rounding) return false;
    }
  }
  return true;
}

/// Nodes of the first element in a tet10 fan, and the offset to those of the next element; p, q and their
/// midpoint belong to all elements.
constexpr std::uint32_t quadratic_fan_nodes[10] = {0, 1, 3, 7, 2, 5, 4, 8, 6, 9};
constexpr std::uint32_t quadratic_fan_step = 4;

}  // namespace

std::uint32_t WorkItems::nodes_of(simd::Shape shape, std::uint32_t length) const {
  switch (shape) {
    case simd::Shape::open_fan:
      return type == ElementType::tet10 ? quadratic_fan_step * length + 6 : length + 3;
    case simd::Shape::closed_fan: return length + 2;
    case simd::Shape::affine:
    case simd::Shape::general: break;
  }
  return static_cast<std::uint32_t>(nodes_per_element(type));
}

std::uint32_t WorkItems::points_of(simd::Shape shape, std::uint32_t length) const {
  switch (shape) {
    case simd::Shape::open_fan:
    case simd::Shape::closed_fan: return static_cast<std::uint32_t>(points_per_element(type)) * length;
    case simd::Shape::affine:
    case simd::Shape::general: break;
  }
  return static_cast<std::uint32_t>(points_per_element(type));
}

std::uint32_t WorkItems::node_of(simd::Shape shape, std::uint32_t length, std::uint32_t i,
                                 std::uint32_t a) const {
  if (shape != simd::Shape::open_fan && shape != simd::Shape::closed_fan) return a;
  if (type == ElementType::tet10) {
    const std::uint32_t first = quadratic_fan_nodes[a];
    return first < 3 ? first : first + quadratic_fan_step * i;
  }
  return a < 2 ? a : 2 + (i + a - 2) % (nodes_of(shape, length) - 2);
}

WorkItems make_work_items(const Body& body) {
  const MeshView& mesh = body.mesh;
  const auto nodes = static_cast<std::uint32_t>(nodes_per_element(mesh.type));
  std::vector<bool> single(mesh.element_count(), mesh.type != ElementType::tet4);
  const auto first_node = [&](std::size_t e) { return &mesh.connectivity[e * nodes]; };
  for (std::size_t e = 0; mesh.type == ElementType::tet10 && e < single.size(); ++e)
    single[e] = !elements::has_straight_sides(elements::coordinates_of<elements::Tet10>(mesh, e));
  WorkItems result;
  if (cell(mesh.type).simplex && dimension(mesh.type) == 3) result = cover_by_fans(body, single);
  result.type = mesh.type;
  for (std::uint32_t e = 0; e < single.size(); ++e) {
    if (!single[e]) continue;
    const bool affine = mesh.type == ElementType::hex8 && parallelepiped(mesh, first_node(e));
    result.list.push_back({affine ? simd::Shape::affine : simd::Shape::general, 1, body.law_index(e),
                           static_cast<std::uint32_t>(result.nodes.size()),
                           static_cast<std::uint32_t>(result.elements.size())});
    result.nodes.insert(result.nodes.end(), first_node(e), first_node(e) + nodes);
    result.elements.push_back(static_cast<std::int32_t>(e));
  }
  return result;
}

namespace {

using Index = std::int32_t;

/// Local edges of a tetrahedron (p, q), and the other two nodes a, b such that (p, q, a, b) keeps its
/// orientation.
constexpr std::array<std::array<std::uint8_t, 4>, 6> edges{
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

/// Edges of the mesh and the tetrahedra around each edge, as 8 × element + local edge.
struct EdgeTable {
  std::vector<std::uint32_t> first;  ///< index into `around` of each edge; one more entry than edges
  std::vector<std::uint32_t> around;

  std::size_t size() const { return first.size() - 1; }
  std::span<const std::uint32_t> of(std::uint32_t edge) const {
    return std::span(around).subspan(first[edge], first[edge + 1] - first[edge]);
  }
};

/// The nodes of each tetrahedron, from local copies of pointer and stride.
class Tetrahedra {
 public:
  explicit Tetrahedra(const MeshView& mesh)
      : nodes_(mesh.connectivity.data()), stride_(static_cast<std::size_t>(nodes_per_element(mesh.type))) {}

  const Index* operator[](std::size_t element) const { return nodes_ + element * stride_; }
  /// Lower and higher end node of a local edge, numbered as in EdgeTable::around.
  std::pair<Index, Index> ends(std::uint32_t place) const {
    const Index* node = (*this)[place / 8];
    const auto& edge = edges[place % 8];
    const Index a = node[edge[0]], b = node[edge[1]];
    return {std::min(a, b), std::max(a, b)};
  }

 private:
  const Index* nodes_;
  std::size_t stride_;
};

/// Sorts the local edges of all tetrahedra by their higher and then, in place, by their lower end node: two
/// counting sorts, because both keys are node numbers.
EdgeTable make_edges(const MeshView& mesh) {
  const Tetrahedra tetrahedra(mesh);
  std::vector<std::uint32_t> low_start(mesh.node_count() + 1, 0), high_start(low_start);
  const auto count = static_cast<std::uint32_t>(mesh.element_count());
  const auto for_each_place = [&](const auto& visit) {
    for (std::uint32_t e = 0; e < count; ++e)
      for (std::uint32_t k = 0; k < edges.size(); ++k) visit(8 * e + k);
  };
  for_each_place([&](std::uint32_t place) {
    const auto [low, high] = tetrahedra.ends(place);
    ++low_start[at(low) + 1];
    ++high_start[at(high) + 1];
  });
  std::partial_sum(low_start.begin(), low_start.end(), low_start.begin());
  std::partial_sum(high_start.begin(), high_start.end(), high_start.begin());
  EdgeTable table;
  table.around.resize(edges.size() * count);
  std::vector<std::uint32_t> by_high(table.around.size());
  for_each_place([&](std::uint32_t place) { by_high[high_start[tetrahedra.ends(place).second]++] = place; });
  for (const std::uint32_t place : by_high) table.around[low_start[tetrahedra.ends(place).first]++] = place;
  std::pair<Index, Index> before{-1, -1};
  for (std::uint32_t i = 0; i < table.around.size(); ++i)
    if (const auto ends = tetrahedra.ends(table.around[i]); std::exchange(before, ends) != ends)
      table.first.push_back(i);
  table.first.push_back(static_cast<std::uint32_t>(table.around.size()));
  return table;
}

/// Edges that are the longest of every tetrahedron around them. Preferred among equals, they keep a cover
/// regular: in a box split along its diagonals, fans of six around the diagonals tile it.
std::vector<bool> longest_of_all(const MeshView& mesh, const EdgeTable& table) {
  const Tetrahedra tetrahedra(mesh);
  std::vector<std::uint8_t> longest(mesh.element_count());
  for (std::size_t e = 0; e < longest.size(); ++e) {
    const Index* t = tetrahedra[e];
    std::array<const double*, 4> x;
    for (std::size_t a = 0; a < 4; ++a) x[a] = &mesh.coordinates[3 * at(t[a])];
    double best = -1.0;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const double *from = x[edges[k][0]], *to = x[edges[k][1]];
      double square = 0.0;
      for (std::size_t c = 0; c < 3; ++c) square += (from[c] - to[c]) * (from[c] - to[c]);
      if (square > best) best = square, longest[e] = static_cast<std::uint8_t>(k);
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
  WorkItems result;

  /// One tetrahedron around the edge, as the arc from ring node `a` to ring node `b`.
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
    result.list.push_back({closed ? simd::Shape::closed_fan : simd::Shape::open_fan,
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
    const Index* node = Tetrahedra(mesh)[at(element)];
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

  /// Splits the arcs around (p, q) into the longest possible chains of one law, and adds them.
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
    for (const bool rings : {false, true})  // open chains first; the rest are closed rings
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

WorkItems cover_by_fans(const Body& body, std::vector<bool> taken) {
  const MeshView& mesh = body.mesh;
  const Tetrahedra tetrahedra(mesh);
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
  // Counts only decrease: an edge in too high a bucket moves down to its present count.
  for (std::size_t bucket = queue.size(); bucket-- > 2;) {
    for (std::size_t i = 0; i < queue[bucket].size(); ++i) {
      const std::uint32_t edge = queue[bucket][i];
      const std::uint32_t left = left_of(edge);
      if (left < bucket / 2) {
        if (left > 0) enqueue(edge, left);
        continue;
      }
      const Index low = tetrahedra.ends(table.of(edge)[0]).first;
      Index p = 0, q = 0;
      cover.arcs.clear();
      for (const std::uint32_t place : table.of(edge)) {
        const std::uint32_t e = place / 8;
        if (taken[e]) continue;
        taken[e] = true;
        const Index* t = tetrahedra[e];
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
