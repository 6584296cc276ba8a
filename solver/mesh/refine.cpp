// SPDX-License-Identifier: BSD-3-Clause
// Uniform refinement, which halves every edge and keeps groups and curved edges; and conversion of linear to
// quadratic elements.
#include <kacanov/refine.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include "mesh/new_nodes.hpp"

namespace kacanov {
namespace {

/// Bit set of corners of an element; it stands for their midpoint.
using Corners = std::uint32_t;

constexpr Corners bit(std::size_t corner) { return Corners{1} << corner; }

/// Corners of the children of one element: children × corners. In a tetrahedron's inner octahedron the four
/// inner children share the diagonal from the middle of edge 0–`diagonal` (1, 2, 3).
std::vector<Corners> children_of(const Cell& type, std::size_t diagonal) {
  const std::size_t corners = type.corners;
  std::vector<Corners> children;
  for (std::size_t child = 0; child < corners; ++child)
    for (std::size_t a = 0; a < corners; ++a) {
      if (type.simplex) {
        children.push_back(bit(child) | bit(a));
        continue;
      }
      Corners around = 0;  // corners on every side that contains both corners
      for (std::size_t b = 0; b < corners; ++b) {
        bool in = true;
        for (std::size_t k = 0; k < static_cast<std::size_t>(type.dim); ++k)
          in = in && (type.reference[child][k] != type.reference[a][k] ||
                      type.reference[b][k] == type.reference[a][k]);
        if (in) around |= bit(b);
      }
      children.push_back(around);
    }
  if (!type.simplex) return children;
  const auto middle = [](std::size_t a, std::size_t b) { return bit(a) | bit(b); };
  if (type.dim == 2) {
    for (const Corners corner : {middle(0, 1), middle(1, 2), middle(2, 0)}) children.push_back(corner);
    return children;
  }
  const std::size_t i = diagonal, j = i % 3 + 1, k = j % 3 + 1;
  const std::array ring{middle(0, j), middle(0, k), middle(i, k), middle(i, j)};
  for (std::size_t t = 0; t < 4; ++t)
    for (const Corners corner : {middle(0, i), middle(j, k), ring[t], ring[(t + 1) % 4]})
      children.push_back(corner);
  return children;
}

std::size_t children_count(const Cell& type) { return std::size_t{1} << type.dim; }

class Refinement {
 public:
  explicit Refinement(const Mesh& coarse) : coarse_(coarse), type_(cell(coarse.type)) {}

  Mesh done() {
    fine_ = with_nodes_of(coarse_, coarse_.type);
    for (std::size_t d = 1; d < patterns_.size(); ++d) patterns_[d] = children_of(type_, d);
    fine_.elements.reserve(coarse_.elements.size() * children_count(type_));
    for (std::size_t e = 0; e < coarse_.element_count(); ++e) split(e);
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

  /// Returns the node at the middle of an edge or of a quadrilateral's diagonal; creates it at `at` if
  /// needed, with field values averaged over `around`.
  std::int32_t between(std::int32_t a, std::int32_t b, const std::array<double, 3>& at,
                       std::span<const std::int32_t> around) {
    const auto [place, fresh] = between_.try_emplace(pair_key(a, b), 0);
    if (fresh) place->second = add(at, around);
    return place->second;
  }

  std::int32_t add(const std::array<double, 3>& at, std::span<const std::int32_t> around) {
    return add_node(fine_, at, around,
                    "mesh.refine: so fine a mesh has more unknowns than 32-bit indices can number");
  }

  /// Maps reference coordinates to space.
  std::array<double, 3> position(std::span<const std::int32_t> of, const std::array<double, 3>& xi) const {
    std::array<double, most_nodes> shape{};
    type_.values(xi.data(), shape.data());
    // Long double, rounded once, so that the result does not depend on the order of the sum.
    std::array<long double, 3> x{};
    for (std::size_t a = 0; a < of.size(); ++a)
      for (std::size_t c = 0; c < dim(); ++c)
        x[c] += static_cast<long double>(shape[a]) *
                coarse_.coordinates[static_cast<std::size_t>(of[a]) * dim() + c];
    return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
  }

  std::array<double, 3> reference(Corners corners) const {
    std::array<double, 3> xi{};
    double count = 0.0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(type_.corners); ++a)
      if ((corners & bit(a)) != 0) {
        count += 1.0;
        for (std::size_t c = 0; c < 3; ++c) xi[c] += type_.reference[a][c];
      }
    for (double& c : xi) c /= count;
    return xi;
  }

  /// Returns the node of a child's corner, which is the midpoint of these corners of its parent.
  std::int32_t corner(std::span<const std::int32_t> of, Corners corners) {
    std::array<std::int32_t, 8> around{};
    std::array<std::size_t, 8> local{};
    std::size_t count = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(type_.corners); ++a)
      if ((corners & bit(a)) != 0) {
        local[count] = a;
        around[count++] = of[a];
      }
    if (count == 1) return around[0];
    const std::array<double, 3> xi = reference(corners);
    const auto all = std::span(around).first(count);
    if (count == 2) {
      for (const CellEdge& edge : type_.edges)
        if (edge.middle >= 0 && corners == (bit(edge.a) | bit(edge.b))) return of[edge.middle];
      return between(around[0], around[1], position(of, xi), all);
    }
    if (count == static_cast<std::size_t>(type_.corners)) {  // the element's own centre
      if (inner_ < 0) inner_ = add(position(of, xi), all);
      return inner_;
    }
    // The key of a quadrilateral is its lowest node and the opposite one.
    const auto lowest =
        static_cast<std::size_t>(std::min_element(around.begin(), around.begin() + 4) - around.begin());
    std::size_t across = lowest;
    for (std::size_t b = 0; b < 4; ++b)
      if (distance(local[b], local[lowest]) > distance(local[across], local[lowest])) across = b;
    return between(around[lowest], around[across], position(of, xi), all);
  }

  double distance(std::size_t a, std::size_t b) const {
    double square = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = type_.reference[a][c] - type_.reference[b][c];
      square += d * d;
    }
    return square;
  }

  /// Returns the shortest diagonal of a tetrahedron's inner octahedron.
  std::size_t diagonal(std::span<const std::int32_t> of) const {
    if (type_.dim == 2 || !type_.simplex) return 1;
    std::size_t best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i <= 3; ++i) {
      const std::size_t j = i % 3 + 1, k = j % 3 + 1;
      const auto from = position(of, reference(bit(0) | bit(i))),
                 to = position(of, reference(bit(j) | bit(k)));
      double square = 0.0;
      for (std::size_t c = 0; c < 3; ++c) square += (from[c] - to[c]) * (from[c] - to[c]);
      if (square < least * (1.0 - 1e-9)) {
        least = square;
        best = i;
      }
    }
    return best;
  }

  void split(std::size_t e) {
    const auto of = nodes(e);
    inner_ = -1;
    const std::vector<Corners>& pattern = patterns_[diagonal(of)];
    const std::size_t corners = type_.corners;
    for (std::size_t child = 0; child < pattern.size(); child += corners) {
      const std::size_t first = fine_.elements.size();
      for (std::size_t a = 0; a < corners; ++a) fine_.elements.push_back(corner(of, pattern[child + a]));
      for (const CellEdge& edge : type_.edges) {
        if (edge.middle < 0) continue;
        const auto from = reference(pattern[child + edge.a]), to = reference(pattern[child + edge.b]);
        const std::array<double, 3> xi{0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]),
                                       0.5 * (from[2] + to[2])};
        const std::array ends{fine_.elements[first + edge.a], fine_.elements[first + edge.b]};
        fine_.elements.push_back(between(ends[0], ends[1], position(of, xi), ends));
      }
    }
  }

  void take_over(const Group& group) {
    Group to{group.name, group.dimension, {}};
    if (group.dimension == type_.dim)
      elements_of(group, to.members);
    else if (group.dimension == type_.dim - 1)
      facets_of(group, to.members);
    else
      to.members = with_middles(group, fine_.node_count(), between_);
    std::sort(to.members.begin(), to.members.end());
    fine_.groups.push_back(std::move(to));
  }

  void elements_of(const Group& group, std::vector<std::int32_t>& members) const {
    const auto children = static_cast<std::int32_t>(children_count(type_));
    for (const std::int32_t e : group.members)
      for (std::int32_t c = 0; c < children; ++c) members.push_back(e * children + c);
  }

  /// Appends the fine facets inside the facets of a group.
  void facets_of(const Group& group, std::vector<std::int32_t>& members) {
    const Cell& type = type_.facet();
    const std::size_t corners = type.corners;
    if (!facet_) facet_.emplace(fine_);
    std::vector<std::array<std::int32_t, 4>> children;
    for (const std::int32_t f : group.members) {
      children.clear();
      split_facet(coarse_.facet(f), children);
      for (const auto& child : children)
        if (const std::int32_t found = facet_->find(std::span(child).first(corners)); found >= 0)
          members.push_back(found);
    }
  }

  std::int32_t known(std::int32_t a, std::int32_t b) const {
    const auto found = between_.find(pair_key(a, b));
    return found == between_.end() ? -1 : found->second;
  }

  void split_facet(std::span<const std::int32_t> of,
                   std::vector<std::array<std::int32_t, 4>>& children) const {
    const Cell& type = type_.facet();
    const std::size_t corners = type.corners;
    std::array<std::int32_t, 4> middle{};  // of the edge from each corner to the next
    for (std::size_t a = 0; a < corners; ++a) {
      const std::size_t b = (a + 1) % corners;
      middle[a] = type.order == 2 ? of[corners + a] : known(of[a], of[b]);
    }
    if (corners == 2) {
      children.push_back({of[0], middle[0]});
      children.push_back({middle[0], of[1]});
      return;
    }
    for (std::size_t a = 0; a < corners; ++a) {
      std::array<std::int32_t, 4> child{of[a], middle[a], middle[(a + corners - 1) % corners]};
      if (corners == 4) child[3] = centre(of);
      children.push_back(child);
    }
    if (corners == 3) children.push_back(middle);
  }

  std::int32_t centre(std::span<const std::int32_t> of) const {
    const auto lowest = static_cast<std::size_t>(std::min_element(of.begin(), of.begin() + 4) - of.begin());
    return known(of[lowest], of[(lowest + 2) % 4]);
  }

  const Mesh& coarse_;
  const Cell& type_;
  Mesh fine_;
  std::array<std::vector<Corners>, 4> patterns_;  ///< by diagonal, from 1
  MiddleNodes between_;
  std::optional<FacetIndex> facet_;
  std::int32_t inner_ = -1;  ///< node at the centre of the current element
};

}  // namespace

Mesh refine(const Mesh& mesh) { return Refinement(mesh).done(); }

namespace {

/// Returns the mid-side node of the edge from a to b, and creates it if needed.
std::int32_t middle(Mesh& mesh, MiddleNodes& middles, std::int32_t a, std::int32_t b) {
  const auto [place, fresh] = middles.try_emplace(pair_key(a, b), 0);
  if (!fresh) return place->second;
  const std::size_t dim = mesh.dim();
  std::array<double, 3> at{};
  for (std::size_t c = 0; c < dim; ++c)
    at[c] = 0.5 * (mesh.coordinates[a * dim + c] + mesh.coordinates[b * dim + c]);
  place->second = add_node(mesh, at, std::array{a, b},
                           "mesh.order: so many nodes have more unknowns than 32-bit indices can number");
  return place->second;
}

/// Returns the members that a group of the linear mesh has in the quadratic mesh.
std::vector<std::int32_t> members_of(const Group& group, const Mesh& linear, const FacetIndex& facets,
                                     const MiddleNodes& middles) {
  if (group.dimension == linear.dim() || group.dimension == 0) return group.members;
  std::vector<std::int32_t> members;
  if (group.dimension == linear.dim() - 1) {
    for (const std::int32_t f : group.members) members.push_back(facets.find(linear.facet(f)));
  } else {
    members = with_middles(group, linear.node_count(), middles);
  }
  std::sort(members.begin(), members.end());
  return members;
}

}  // namespace

ElementType raised(ElementType type) {
  if (type == ElementType::tet4) return ElementType::tet10;
  throw InputError("mesh.order: 2 makes tet10 of tet4, and the mesh is of " + std::string(cell(type).name));
}

Mesh raise_order(const Mesh& linear) {
  Mesh mesh = with_nodes_of(linear, raised(linear.type));
  mesh.element_tags = linear.element_tags;
  const Cell& type = cell(mesh.type);
  const std::size_t corners = type.corners;
  mesh.elements.reserve(linear.element_count() * static_cast<std::size_t>(type.nodes));
  MiddleNodes middles;
  for (std::size_t e = 0; e < linear.element_count(); ++e) {
    const auto of = std::span(linear.elements).subspan(e * corners, corners);
    mesh.elements.insert(mesh.elements.end(), of.begin(), of.end());
    for (const CellEdge& edge : type.edges)
      mesh.elements.push_back(middle(mesh, middles, of[edge.a], of[edge.b]));
  }
  number_new_nodes(mesh);
  find_boundary(mesh);
  const FacetIndex facets(mesh);
  for (const Group& group : linear.groups)
    mesh.groups.push_back({group.name, group.dimension, members_of(group, linear, facets, middles)});
  return mesh;
}

}  // namespace kacanov
