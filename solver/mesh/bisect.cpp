// SPDX-License-Identifier: BSD-3-Clause
// Refinement of marked elements by longest-edge bisection, with groups and curved edges.
#include <kacanov/refine.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include "mesh/new_nodes.hpp"

namespace kacanov {
namespace {

using Point = std::array<double, 3>;

/// A simplex during bisection, or a facet of one: its corners, and their reference coordinates in the element
/// that it is cut from.
struct CutPiece {
  std::array<std::int32_t, 4> node{};
  std::array<Point, 4> xi{};
};

struct CutEdge {
  std::size_t a = 0, b = 0;  ///< corners
};

class Bisection {
 public:
  explicit Bisection(const Mesh& coarse)
      : coarse_(coarse), type_(cell(coarse.type)), corners_(static_cast<std::size_t>(type_.corners)) {}

  Mesh done(std::span<const std::int32_t> marked) {
    fine_ = with_nodes_of(coarse_, coarse_.type);
    keep_middles();
    std::vector<std::uint8_t> generations(coarse_.element_count(), 0);
    for (const std::int32_t e : marked) generations[e] = static_cast<std::uint8_t>(type_.dim);
    // A cut may require another one in a neighbour that has a different longest edge.
    for (std::size_t before = 1; halved_.size() != before;) {
      before = halved_.size();
      for (std::size_t e = 0; e < coarse_.element_count(); ++e)
        cut(
            whole(e), generations[e],
            [&](const CutPiece& piece, CutEdge edge) { halve(nodes(e), piece, edge); },
            [](const CutPiece&) {});
    }
    first_child_.reserve(coarse_.element_count() + 1);
    for (std::size_t e = 0; e < coarse_.element_count(); ++e) {
      first_child_.push_back(static_cast<std::int32_t>(fine_.element_count()));
      cut(
          whole(e), generations[e], [](const CutPiece&, CutEdge) {},
          [&](const CutPiece& piece) { emit(nodes(e), piece); });
    }
    first_child_.push_back(static_cast<std::int32_t>(fine_.element_count()));
    number_new_nodes(fine_);
    find_boundary(fine_);
    for (const Group& group : coarse_.groups) take_over(group);
    return std::move(fine_);
  }

 private:
  std::size_t dim() const { return static_cast<std::size_t>(type_.dim); }

  std::span<const std::int32_t> nodes(std::size_t e) const {
    const std::size_t n = type_.nodes;
    return std::span(coarse_.elements).subspan(e * n, n);
  }

  CutPiece whole(std::size_t e) const {
    CutPiece piece;
    for (std::size_t a = 0; a < corners_; ++a) {
      piece.node[a] = nodes(e)[a];
      piece.xi[a] = type_.reference[a];
    }
    return piece;
  }

  /// Square of the straight distance between two nodes; the same bits for either order.
  double length(std::int32_t a, std::int32_t b) const {
    const auto low = static_cast<std::size_t>(std::min(a, b)),
               high = static_cast<std::size_t>(std::max(a, b));
    double square = 0.0;
    for (std::size_t c = 0; c < dim(); ++c) {
      const double d = fine_.coordinates[low * dim() + c] - fine_.coordinates[high * dim() + c];
      square += d * d;
    }
    return square;
  }

  /// Longest edge under a total order of edges on which all elements agree.
  CutEdge longest_edge(const CutPiece& piece, std::size_t corners) const {
    CutEdge longest{1, 0};
    double most = -1.0;
    for (std::size_t a = 0; a < corners; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const double here = length(piece.node[a], piece.node[b]);
        // Lengths that differ only by rounding count as equal.
        const bool equal = std::abs(here - most) <= 1e-12 * most;
        const bool first =
            pair_key(piece.node[a], piece.node[b]) < pair_key(piece.node[longest.a], piece.node[longest.b]);
        if (equal ? first : here > most) {
          longest = {a, b};
          most = here;
        }
      }
    return longest;
  }

  bool is_halved(const CutPiece& piece, CutEdge edge) const {
    return halved_.contains(pair_key(piece.node[edge.a], piece.node[edge.b]));
  }
  bool any_halved(const CutPiece& piece) const {
    for (std::size_t a = 0; a < corners_; ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (is_halved(piece, {a, b})) return true;
    return false;
  }

  std::int32_t add(const Point& at, std::int32_t a, std::int32_t b) {
    return add_node(fine_, at, std::array{a, b},
                    "mesh.adapt: so fine a mesh has more unknowns than 32-bit indices can number");
  }

  /// Maps reference coordinates to space.
  Point position(std::span<const std::int32_t> of, const Point& xi) const {
    std::array<double, most_nodes> shape{};
    type_.values(xi.data(), shape.data());
    Point x{};
    for (std::size_t a = 0; a < of.size(); ++a)
      for (std::size_t c = 0; c < dim(); ++c)
        x[c] += shape[a] * coarse_.coordinates[static_cast<std::size_t>(of[a]) * dim() + c];
    return x;
  }

  static Point middle(const Point& a, const Point& b) {
    return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
  }

  void keep_middles() {
    if (type_.order == 1) return;
    for (std::size_t e = 0; e < coarse_.element_count(); ++e)
      for (const CellEdge& edge : type_.edges)
        between_.try_emplace(pair_key(nodes(e)[edge.a], nodes(e)[edge.b]), nodes(e)[edge.middle]);
  }

  /// Creates the node at the middle of an edge of `piece`; `of` are the nodes of its element.
  void halve(std::span<const std::int32_t> of, const CutPiece& piece, CutEdge edge) {
    const std::int32_t a = piece.node[edge.a], b = piece.node[edge.b];
    const auto there = between_.find(pair_key(a, b));
    halved_.emplace(pair_key(a, b),
                    there != between_.end()
                        ? there->second
                        : add(position(of, middle(piece.xi[edge.a], piece.xi[edge.b])), a, b));
  }

  /// Bisects `piece` at its longest edge `generations` times, and further while one of its edges is halved,
  /// and calls emit(piece) for the resulting pieces. Calls halve(piece, edge) for edges that are not halved
  /// yet.
  template <class Halve, class Emit>
  void cut(const CutPiece& piece, int generations, const Halve& halve, const Emit& emit) const {
    if (generations <= 0 && !any_halved(piece)) return emit(piece);
    const CutEdge edge = longest_edge(piece, corners_);
    if (!is_halved(piece, edge)) halve(piece, edge);
    for (const CutPiece& half : halves(piece, edge)) cut(half, generations - 1, halve, emit);
  }

  std::array<CutPiece, 2> halves(const CutPiece& piece, CutEdge edge) const {
    const std::int32_t node = halved_.at(pair_key(piece.node[edge.a], piece.node[edge.b]));
    std::array<CutPiece, 2> both{piece, piece};
    both[0].node[edge.a] = both[1].node[edge.b] = node;
    both[0].xi[edge.a] = both[1].xi[edge.b] = middle(piece.xi[edge.a], piece.xi[edge.b]);
    return both;
  }

  void emit(std::span<const std::int32_t> of, const CutPiece& piece) {
    fine_.elements.insert(fine_.elements.end(), piece.node.begin(),
                          piece.node.begin() + static_cast<std::ptrdiff_t>(corners_));
    for (const CellEdge& edge : type_.edges) {
      if (edge.middle < 0) continue;
      const std::int32_t a = piece.node[edge.a], b = piece.node[edge.b];
      const auto [place, fresh] = between_.try_emplace(pair_key(a, b), 0);
      if (fresh) {
        place->second = add(position(of, middle(piece.xi[edge.a], piece.xi[edge.b])), a, b);
        new_middles_.push_back({a, b, place->second});
      }
      fine_.elements.push_back(place->second);
    }
  }

  void take_over(const Group& group) {
    Group to{group.name, group.dimension, {}, group.inner};
    if (group.dimension == type_.dim) {
      for (const std::int32_t e : group.members)
        for (std::int32_t c = first_child_[e]; c < first_child_[e + 1]; ++c) to.members.push_back(c);
    } else if (group.dimension == type_.dim - 1) {
      facets_of(group, to.members);
    } else {
      nodes_of(group, to.members);
    }
    std::sort(to.members.begin(), to.members.end());
    fine_.groups.push_back(std::move(to));
  }

  /// Appends the fine facets inside the facets of a group. A facet is cut when its element is cut, at the
  /// facet's own longest edge.
  void facets_of(const Group& group, std::vector<std::int32_t>& members) {
    const std::size_t corners = type_.facet().corners;
    if (!facet_) facet_.emplace(fine_);
    for (const std::int32_t f : group.members) {
      CutPiece facet;
      std::copy_n(coarse_.facet(f).begin(), corners, facet.node.begin());
      find_pieces(facet, corners, members);
    }
  }

  void find_pieces(const CutPiece& facet, std::size_t corners, std::vector<std::int32_t>& members) const {
    const CutEdge edge = longest_edge(facet, corners);
    if (is_halved(facet, edge)) {
      for (const CutPiece& half : halves(facet, edge)) find_pieces(half, corners, members);
    } else if (const std::int32_t found = facet_->find(std::span(facet.node).first(corners)); found >= 0) {
      members.push_back(found);
    }
  }

  /// Members of a node group: a point keeps its node; a line also gets the midpoints of edges whose ends it
  /// contains.
  void nodes_of(const Group& group, std::vector<std::int32_t>& members) const {
    members = group.members;
    if (group.dimension == 0) return;
    std::vector<char> in(fine_.node_count(), 0);
    for (const std::int32_t n : group.members) in[n] = 1;
    const auto take = [&](std::int32_t a, std::int32_t b, std::int32_t node) {
      if (in[a] == 0 || in[b] == 0 || in[node] != 0) return;
      in[node] = 1;
      members.push_back(node);
    };
    // Halved edges may be halved again.
    for (std::size_t before = 0; members.size() != before;) {
      before = members.size();
      for (const auto& [pair, node] : halved_)
        take(static_cast<std::int32_t>(pair >> 32), static_cast<std::int32_t>(pair & 0xffffffffU), node);
    }
    for (const auto& [a, b, node] : new_middles_) take(a, b, node);
  }

  const Mesh& coarse_;
  const Cell& type_;
  std::size_t corners_;
  Mesh fine_;
  MiddleNodes halved_;                                    ///< midpoints of halved edges
  MiddleNodes between_;                                   ///< mid-side nodes, old and new
  std::vector<std::array<std::int32_t, 3>> new_middles_;  ///< two ends and the node
  std::vector<std::int32_t> first_child_;                 ///< per element, plus the end
  std::optional<FacetIndex> facet_;
};

}  // namespace

bool can_bisect(ElementType type) { return cell(type).simplex; }

void refuse_to_bisect(ElementType type) {
  if (can_bisect(type)) return;
  throw InputError("mesh.adapt: expected " + element_names([](const Cell& c) { return c.simplex; }) +
                   ", got " + std::string(cell(type).name));
}

Mesh bisect(const Mesh& mesh, std::span<const std::int32_t> marked) {
  refuse_to_bisect(mesh.type);
  return Bisection(mesh).done(marked);
}

std::vector<std::int32_t> worst_elements(std::span<const double> energy, double share) {
  std::vector<std::int32_t> order(energy.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return energy[a] > energy[b] || (energy[a] == energy[b] && a < b);
  });
  const double all = std::accumulate(energy.begin(), energy.end(), 0.0);
  double sum = 0.0;
  std::size_t count = 0;
  while (count < order.size() && sum < share * all) sum += energy[order[count++]];
  order.resize(count);
  return order;
}

}  // namespace kacanov
