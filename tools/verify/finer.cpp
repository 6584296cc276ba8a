// SPDX-License-Identifier: BSD-3-Clause
// Refines the mesh of a file: halves every edge, or adds a node at the middle of every straight edge (user
// guide: refine, order).
#include "verify/finer.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace kacanov::verify {
namespace {

/// Corner places within an element.
using Places = std::vector<std::size_t>;

/// Midpoint of some corners of the reference cell.
Vec middle_of(Shape shape, const Places& places) {
  static const Vec simplex[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const Vec product[] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  const bool is_product = shape == Shape::quad4 || shape == Shape::hex8;
  Vec sum{};
  for (const std::size_t place : places) sum = sum + (is_product ? product : simplex)[place];
  Vec middle = 1 / static_cast<Real>(places.size()) * sum;
  if (shape == Shape::quad4) middle[2] = 0;
  return middle;
}

/// Child elements: each corner of a child is given by the parent corners whose midpoint it is.
std::vector<std::vector<Places>> children(Shape shape, std::size_t diagonal) {
  const std::vector<std::vector<int>> sides = facets(corner_shape(shape));
  const auto corners = static_cast<std::size_t>(corner_count(shape));
  std::vector<std::vector<Places>> all;
  for (std::size_t child = 0; child < corners; ++child) {
    std::vector<Places> of;
    for (std::size_t a = 0; a < corners; ++a) {
      std::set<std::size_t> around;  // corners on all sides that contain both
      for (std::size_t b = 0; b < corners; ++b) around.insert(b);
      if (shape == Shape::quad4 || shape == Shape::hex8) {
        for (const std::vector<int>& side : sides) {
          const auto has = [&](std::size_t place) {
            return std::find(side.begin(), side.end(), static_cast<int>(place)) != side.end();
          };
          if (has(child) && has(a)) std::erase_if(around, [&](std::size_t b) { return !has(b); });
        }
      } else {
        around = {child, a};
      }
      if (child == a) around = {a};
      of.emplace_back(around.begin(), around.end());
    }
    all.push_back(of);
  }
  if (corner_shape(shape) == Shape::tri3) all.push_back({{0, 1}, {1, 2}, {0, 2}});
  if (corner_shape(shape) != Shape::tet4) return all;
  // The inner octahedron is split along the diagonal from the midpoint of edge 0–i to that of the opposite
  // edge.
  const std::size_t i = diagonal, j = i % 3 + 1, k = j % 3 + 1;
  const std::vector<Places> ring{{0, j}, {0, k}, {i, k}, {i, j}};
  for (std::size_t t = 0; t < 4; ++t) all.push_back({{0, i}, {j, k}, ring[t], ring[(t + 1) % 4]});
  return all;
}

const std::pair<int, int> tet_edges[] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}};

class Finer {
 public:
  explicit Finer(const Mesh& coarse) : coarse_(coarse), fine_(coarse) {
    fine_.elements.clear();
    std::set<Index> used;
    for (const Indices& element : coarse.elements) used.insert(element.begin(), element.end());
    for (const Index node : used) next_ = std::max(next_, coarse.tags[node]);
    fine_.made_of.resize(coarse.nodes.size());
    if (coarse.shape != Shape::tet10) return;
    for (const Indices& element : coarse.elements)
      for (std::size_t e = 0; e < 6; ++e)
        fine_.made_of[element[4 + e]] = {element[tet_edges[e].first], element[tet_edges[e].second]};
  }

  Mesh halved() {
    for (const Indices& element : coarse_.elements) split(element);
    const std::size_t each = fine_.elements.size() / coarse_.elements.size();
    for (NamedGroup& group : fine_.groups) {
      const std::vector<Indices> cells = group.cells;
      group.cells.clear();
      for (const Indices& cell : cells) {
        if (group.dimension == coarse_.dim())
          for (std::size_t c = 0; c < each; ++c)
            group.cells.push_back({static_cast<Index>(static_cast<std::size_t>(cell[0]) * each + c)});
        else if (group.dimension == coarse_.dim() - 1)
          split_facet(cell, group.cells);
        else
          group.cells.push_back(cell);
      }
      if (group.dimension == 1 && coarse_.dim() == 3) add_middles(group);
    }
    return fine_;
  }

  Mesh raised() {
    fine_.shape = Shape::tet10;
    for (const Indices& element : coarse_.elements) {
      Indices of = element;
      for (const auto& [a, b] : tet_edges) {
        const Vec sum = coarse_.nodes[element[a]] + coarse_.nodes[element[b]];
        of.push_back(between({element[a], element[b]}, in_double(Real(1) / 2 * sum)));
      }
      fine_.elements.push_back(of);
    }
    for (NamedGroup& group : fine_.groups)
      if (group.dimension == 1) add_middles(group);
    return fine_;
  }

 private:
  /// Rounded to double as in the program.
  static Vec in_double(Vec x) {
    for (Real& component : x) component = static_cast<double>(component);
    return x;
  }

  Vec place(const Indices& element, const Vec& xi) const {
    const Functions f = functions(coarse_.shape, xi);
    Vec x{};
    for (std::size_t a = 0; a < element.size(); ++a) x = x + f.value[a] * coarse_.nodes[element[a]];
    return in_double(x);
  }

  Index between(Indices parents, const Vec& x) {
    std::sort(parents.begin(), parents.end());
    const auto [at, fresh] = made_.try_emplace(parents, static_cast<Index>(fine_.nodes.size()));
    if (!fresh) return at->second;
    fine_.nodes.push_back(x);
    fine_.tags.push_back(++next_);
    fine_.made_of.push_back(parents);
    return at->second;
  }

  Index corner(const Indices& element, const Places& places) {
    if (places.size() == 1) return element[places[0]];
    if (coarse_.shape == Shape::tet10)
      for (std::size_t e = 0; e < 6; ++e) {
        const auto a = static_cast<std::size_t>(tet_edges[e].first),
                   b = static_cast<std::size_t>(tet_edges[e].second);
        if (places == Places{a, b} || places == Places{b, a}) return element[4 + e];
      }
    Indices parents;
    for (const std::size_t p : places) parents.push_back(element[p]);
    return between(parents, place(element, middle_of(coarse_.shape, places)));
  }

  /// Returns the shortest diagonal of the inner octahedron.
  std::size_t diagonal(const Indices& element) const {
    std::size_t best = 1;
    Real least = HUGE_VALL;
    for (std::size_t i = 1; i <= 3 && corner_shape(coarse_.shape) == Shape::tet4; ++i) {
      const std::size_t j = i % 3 + 1, k = j % 3 + 1;
      const Real length = norm(place(element, middle_of(coarse_.shape, {0, i})) -
                               place(element, middle_of(coarse_.shape, {j, k})));
      if (length * length >= least * least * (1 - 1e-9L)) continue;
      least = length;
      best = i;
    }
    return best;
  }

  void split(const Indices& element) {
    for (const std::vector<Places>& child : children(coarse_.shape, diagonal(element))) {
      Indices of;
      for (const Places& places : child) of.push_back(corner(element, places));
      if (coarse_.shape == Shape::tet10)
        for (const auto& [a, b] : tet_edges) {
          const Vec xi =
              Real(1) / 2 * (middle_of(coarse_.shape, child[a]) + middle_of(coarse_.shape, child[b]));
          of.push_back(between({of[a], of[b]}, place(element, xi)));
        }
      fine_.elements.push_back(of);
    }
  }

  /// Appends the corners of the child facets; nothing if the facet belongs to no element.
  void split_facet(const Indices& facet, std::vector<Indices>& cells) const {
    const bool quadratic = coarse_.shape == Shape::tet10;
    const std::size_t corners = quadratic ? 3 : facet.size();
    const auto known = [&](Indices parents) {
      std::sort(parents.begin(), parents.end());
      const auto found = made_.find(parents);
      return found == made_.end() ? Index(-1) : found->second;
    };
    Indices middle;
    for (std::size_t a = 0; a < corners; ++a)
      middle.push_back(quadratic ? facet[3 + a] : known({facet[a], facet[(a + 1) % corners]}));
    if (corners == 2) middle.pop_back();
    const Index centre = corners == 4 ? known(facet) : 0;
    if (centre < 0 || std::find(middle.begin(), middle.end(), -1) != middle.end()) return;
    if (corners == 2) {
      cells.push_back({facet[0], middle[0]});
      cells.push_back({middle[0], facet[1]});
      return;
    }
    for (std::size_t a = 0; a < corners; ++a) {
      Indices child{facet[a], middle[a], middle[(a + corners - 1) % corners]};
      if (corners == 4) child.push_back(centre);
      cells.push_back(child);
    }
    if (corners == 3) cells.push_back(middle);
  }

  /// Adds to a line group the mid-edge nodes of edges with both ends in the group.
  void add_middles(NamedGroup& group) const {
    std::set<Index> nodes;
    for (const Indices& cell : group.cells) nodes.insert(cell.begin(), cell.end());
    for (const auto& [parents, node] : made_)
      if (parents.size() == 2 && nodes.contains(parents[0]) && nodes.contains(parents[1]))
        group.cells.push_back({node});
  }

  const Mesh& coarse_;
  Mesh fine_;
  std::map<Indices, Index> made_;
  std::int64_t next_ = 0;
};

}  // namespace

Mesh halved(const Mesh& mesh) { return Finer(mesh).halved(); }

Mesh raised(const Mesh& mesh) { return Finer(mesh).raised(); }

}  // namespace kacanov::verify
