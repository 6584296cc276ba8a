// SPDX-License-Identifier: BSD-3-Clause
// Boundary extraction, validation and connected components of meshes.
#include <kacanov/mesh.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>

#include <kacanov/error.hpp>
#include "operator/element_maps.hpp"
#include "parallel/disjoint_sets.hpp"

namespace kacanov {
namespace {

/// One facet of one element, within the bucket of its lowest node: the other corners, ascending, with −1 for
/// unused ones at the end. Packed into two numbers, comparisons take half the time of four.
struct FacetKey {
  std::uint64_t middle = 0;  ///< second and third
  std::uint32_t last = 0;    ///< fourth
  std::uint32_t id = 0;      ///< element · facets_per_element + local facet

  bool same_corners(const FacetKey& other) const { return middle == other.middle && last == other.last; }
  bool operator<(const FacetKey& other) const {
    if (middle != other.middle) return middle < other.middle;
    return last != other.last ? last < other.last : id < other.id;
  }
};

/// The facets of all elements, sorted so that equal corners are adjacent. Buckets by lowest node limit each
/// sort to a few dozen entries, and only the 4-byte ids are stored for the whole mesh.
class FacetSets {
 public:
  explicit FacetSets(const Mesh& mesh)
      : mesh_(mesh),
        table_(cell(mesh.type).facet_nodes),
        facets_(static_cast<std::uint32_t>(facets_per_element(mesh.type))),
        element_nodes_(nodes_per_element(mesh.type)),
        facet_nodes_(nodes_per_facet(mesh.type)),
        corners_(cell(mesh.type).facet().corners) {
    const std::size_t total = mesh.element_count() * facets_;
    if (total > std::numeric_limits<std::uint32_t>::max())
      throw InputError("the mesh has " + std::to_string(mesh.element_count()) +
                       " elements: more than 2^32 element sides cannot be indexed");
    bucket_.assign(mesh.node_count() + 1, 0);
    for_each_lowest_node([&](std::size_t lowest, std::uint32_t) { ++bucket_[lowest + 1]; });
    for (std::size_t i = 1; i < bucket_.size(); ++i) bucket_[i] += bucket_[i - 1];
    ids_.resize(total);
    std::vector<std::uint32_t> next(bucket_.begin(), bucket_.end() - 1);
    for_each_lowest_node([&](std::size_t lowest, std::uint32_t id) { ids_[next[lowest]++] = id; });
  }

  /// Calls visit(span of FacetKey) for every set of facets with the same corners.
  template <typename Visit>
  void visit(Visit&& visit) const {
    std::vector<FacetKey> keys;
    for (std::size_t node = 0; node + 1 < bucket_.size(); ++node) {
      keys.clear();
      for (std::uint32_t i = bucket_[node]; i < bucket_[node + 1]; ++i) keys.push_back(key(ids_[i]));
      std::sort(keys.begin(), keys.end());
      for (std::size_t first = 0; first < keys.size();) {
        std::size_t last = first + 1;
        while (last < keys.size() && keys[last].same_corners(keys[first])) ++last;
        visit(std::span(keys).subspan(first, last - first));
        first = last;
      }
    }
  }

  /// The nodes of one facet; avoids dividing the facet id once per node.
  struct FacetNodes {
    const std::int32_t* element;
    const std::int8_t* local;
    std::int32_t operator[](std::size_t k) const { return element[local[k]]; }
  };
  FacetNodes nodes(std::uint32_t id) const {
    const std::size_t element = id / facets_, facet = id % facets_;
    return {mesh_.elements.data() + element * element_nodes_, table_.data() + facet * facet_nodes_};
  }
  std::size_t element(std::uint32_t id) const { return id / facets_; }
  std::size_t corners() const { return corners_; }
  std::size_t facet_nodes() const { return facet_nodes_; }

 private:
  /// Calls visit(lowest node, id) for all facets, without a division per facet.
  template <typename Visit>
  void for_each_lowest_node(const Visit& visit) const {
    std::uint32_t id = 0;
    for (const std::int32_t* element = mesh_.elements.data(); id < ids(); element += element_nodes_)
      for (const std::int8_t* local = table_.data(); local != table_.data() + table_.size();
           local += facet_nodes_) {
        std::int32_t lowest = element[local[0]];
        for (std::size_t k = 1; k < corners_; ++k) lowest = std::min(lowest, element[local[k]]);
        visit(static_cast<std::size_t>(lowest), id++);
      }
  }
  std::uint32_t ids() const { return static_cast<std::uint32_t>(mesh_.element_count()) * facets_; }

  FacetKey key(std::uint32_t id) const {
    const FacetNodes facet = nodes(id);
    std::array<std::int32_t, 4> corner{-1, -1, -1, -1};
    for (std::size_t k = 0; k < corners_; ++k) {
      const std::int32_t next = facet[k];
      std::size_t place = k;
      for (; place > 0 && corner[place - 1] > next; --place) corner[place] = corner[place - 1];
      corner[place] = next;
    }
    const auto number = [&](std::size_t k) { return static_cast<std::uint32_t>(corner[k]); };
    return {std::uint64_t{number(1)} << 32 | number(2), number(3), id};
  }

  const Mesh& mesh_;
  std::span<const std::int8_t> table_;
  std::uint32_t facets_;
  std::size_t element_nodes_, facet_nodes_, corners_;
  std::vector<std::uint32_t> bucket_;  // by lowest node, offsets into ids_
  std::vector<std::uint32_t> ids_;
};

/// Whether facet b lists the corners of facet a in reverse orientation, as adjacent elements do.
bool opposite(const FacetSets& sets, std::uint32_t a, std::uint32_t b) {
  const std::size_t n = sets.corners();
  const auto of_a = sets.nodes(a), of_b = sets.nodes(b);
  std::size_t other = 0;
  while (of_b[other] != of_a[0]) ++other;
  for (std::size_t k = 1; k < n; ++k) {
    other = other == 0 ? n - 1 : other - 1;
    if (of_a[k] != of_b[other]) return false;
  }
  return true;
}

/// Whether two facets with the same corners also have the same mid-side nodes.
bool same_midsides(const FacetSets& sets, std::uint32_t a, std::uint32_t b) {
  if (sets.corners() == sets.facet_nodes()) return true;
  const auto of_a = sets.nodes(a), of_b = sets.nodes(b);
  std::array<std::int32_t, most_facet_nodes> ma{}, mb{};
  for (std::size_t k = sets.corners(); k < sets.facet_nodes(); ++k) {
    ma[k] = of_a[k];
    mb[k] = of_b[k];
  }
  std::sort(ma.begin(), ma.end());
  std::sort(mb.begin(), mb.end());
  return ma == mb;
}

/// Shape measures of an element that check_mesh() tests.
struct ElementShape {
  double volume = 0.0;    ///< signed
  double smallest = 0.0;  ///< smallest Jacobian determinant times the sum of weights, i.e. a volume as well
  double longest_edge = 0.0;
  double scale = 0.0;  ///< longest edge to the power of the dimension
};

const double* corner_position(const Mesh& mesh, std::size_t element, std::size_t corner) {
  const std::size_t dim = mesh.dim(), nodes = nodes_per_element(mesh.type);
  return &mesh.coordinates[dim * static_cast<std::size_t>(mesh.elements[element * nodes + corner])];
}

double to_the_dimension(const Mesh& mesh, double length) {
  return mesh.dim() == 3 ? length * length * length : length * length;
}

double smallest_volume_of(const Mesh& mesh, const ElementMap& map) {
  const Cell& type = cell(mesh.type);
  return type.weight * static_cast<double>(type.points.size()) * map.least_det;
}

ElementShape shape_of(const Mesh& mesh, std::size_t element, const ElementMap& map) {
  const std::size_t corners = cell(mesh.type).corners, dim = mesh.dim();
  double longest = 0.0;
  for (std::size_t a = 0; a < corners; ++a)
    for (std::size_t b = a + 1; b < corners; ++b) {
      const double *from = corner_position(mesh, element, a), *to = corner_position(mesh, element, b);
      double square = 0.0;
      for (std::size_t k = 0; k < dim; ++k) square += (to[k] - from[k]) * (to[k] - from[k]);
      longest = std::max(longest, square);
    }
  longest = std::sqrt(longest);
  return {map.volume, smallest_volume_of(mesh, map), longest, to_the_dimension(mesh, longest)};
}

std::string number(double value) {
  std::array<char, 32> text{};
  const auto written =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
  return {text.data(), written.ptr};
}

std::string element_name(const Mesh& mesh, std::size_t e) {
  return "element " + std::to_string(mesh.element_tag(e));
}

std::string size_text(const Mesh& mesh, const ElementShape& shape) {
  return std::string(" (") + (mesh.dim() == 2 ? "area " : "volume ") + number(shape.volume) +
         ", longest edge " + number(shape.longest_edge) + ")";
}

/// A negative Jacobian is reported with its place if it is found; otherwise it is only known that the
/// Jacobian at some quadrature point is not positive.
[[noreturn]] void refuse_folded(const Mesh& mesh, std::size_t e, const ElementShape& shape) {
  std::string message = element_name(mesh, e) + " is folded: its Jacobian is not positive everywhere";
  if (const auto negative = find_negative_jacobian(mesh.view(), e)) {
    const std::size_t node =
        static_cast<std::size_t>(nodes_per_element(mesh.type)) * e + negative->nearest_corner;
    message += ", its determinant falls to " + number(negative->det) + " next to node " +
               std::to_string(mesh.node_tag(static_cast<std::size_t>(mesh.elements[node])));
  }
  message += size_text(mesh, shape);
  if (cell(mesh.type).order > 1)
    message += "; are its midside nodes in the right order, and near the middle of their edges?";
  throw InputError(message);
}

constexpr double smallest_volume = 1e-14;  // times the longest edge to the power of the dimension

[[noreturn]] void refuse_element(const Mesh& mesh, std::size_t e, const ElementShape& shape) {
  const std::string size = size_text(mesh, shape);
  if (!std::isfinite(shape.scale) || !std::isfinite(shape.volume))
    throw InputError(element_name(mesh, e) + " is too large to be computed with" + size);
  if (std::abs(shape.volume) <= smallest_volume * shape.scale)
    throw InputError(element_name(mesh, e) + " is degenerate" + size);
  if (shape.volume > 0) refuse_folded(mesh, e, shape);
  std::size_t inverted = 0;
  visit_element_maps(mesh.view(), [&](std::size_t, std::span<const ElementMap> maps) {
    inverted += static_cast<std::size_t>(
        std::count_if(maps.begin(), maps.end(), [](const ElementMap& map) { return map.volume < 0.0; }));
  });
  std::string message = element_name(mesh, e) + " is inverted" + size;
  if (inverted == mesh.element_count())
    message +=
        "; so are all others: the mesh was written with the opposite orientation, reverse its elements";
  else if (inverted > 1)
    message += "; " + std::to_string(inverted) + " elements are";
  throw InputError(message);
}

/// Diagonal of the bounding box of the corners, an upper bound of the longest edge at a third of its cost.
double diagonal(const Mesh& mesh, std::size_t element) {
  const std::size_t corners = cell(mesh.type).corners, dim = mesh.dim();
  double square = 0.0;
  for (std::size_t k = 0; k < dim; ++k) {
    double lower = corner_position(mesh, element, 0)[k], upper = lower;
    for (std::size_t a = 1; a < corners; ++a) {
      const double x = corner_position(mesh, element, a)[k];
      lower = std::min(lower, x);
      upper = std::max(upper, x);
    }
    square += (upper - lower) * (upper - lower);
  }
  return std::sqrt(square);
}

void check_shapes(const Mesh& mesh) {
  // The comparisons are written so that overflow (NaN) also fails.
  const auto is_whole = [](double volume, double smallest, double scale) {
    return volume > smallest_volume * scale && smallest > smallest_volume * scale;
  };
  visit_element_maps(mesh.view(), [&](std::size_t first, std::span<const ElementMap> maps) {
    for (std::size_t k = 0; k < maps.size(); ++k) {
      const std::size_t e = first + k;
      if (is_whole(maps[k].volume, smallest_volume_of(mesh, maps[k]),
                   to_the_dimension(mesh, diagonal(mesh, e)))) {
        if (find_negative_jacobian(mesh.view(), e)) refuse_folded(mesh, e, shape_of(mesh, e, maps[k]));
        continue;
      }
      const ElementShape shape = shape_of(mesh, e, maps[k]);
      if (!is_whole(shape.volume, shape.smallest, shape.scale)) refuse_element(mesh, e, shape);
    }
  });
}

[[noreturn]] void refuse_side(const Mesh& mesh, const FacetSets& sets, std::span<const FacetKey> keys) {
  const auto tag = [&](std::size_t k) { return std::to_string(mesh.element_tag(sets.element(keys[k].id))); };
  if (keys.size() > 2)
    throw InputError("elements " + tag(0) + ", " + tag(1) + " and " + tag(2) +
                     " share one side: the mesh overlaps itself");
  const std::string pair = "elements " + tag(0) + " and " + tag(1);
  if (!opposite(sets, keys[0].id, keys[1].id))
    throw InputError(pair + " lie on the same side of their common nodes: the mesh overlaps itself");
  throw InputError(pair + " share a side but not its midside nodes");
}

void check_nodes(const Mesh& mesh) {
  const std::size_t dim = mesh.dim();
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    if (!std::isfinite(mesh.coordinates[i]))
      throw InputError("node " + std::to_string(mesh.node_tag(i / dim)) +
                       " has a coordinate that is not a finite number");
  const std::size_t nodes = nodes_per_element(mesh.type);
  std::vector<bool> used(mesh.node_count(), false);
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const std::size_t node = mesh.elements[i];
    if (mesh.elements[i] < 0 || node >= used.size())
      throw InputError(element_name(mesh, i / nodes) + " refers to a node that does not exist");
    used[node] = true;
  }
  const auto unused = std::count(used.begin(), used.end(), false);
  if (unused == 0) return;
  const std::size_t first = std::find(used.begin(), used.end(), false) - used.begin();
  std::string message = "node " + std::to_string(mesh.node_tag(first)) + " belongs to no element";
  if (unused > 1) message += " (" + std::to_string(unused) + " nodes do not)";
  throw InputError(message);
}

}  // namespace

void find_boundary(Mesh& mesh) {
  const FacetSets sets(mesh);
  std::vector<std::uint32_t> boundary;
  sets.visit([&](std::span<const FacetKey> keys) {
    if (keys.size() == 1) boundary.push_back(keys[0].id);
  });
  std::sort(boundary.begin(), boundary.end());
  const std::size_t n = nodes_per_facet(mesh.type);
  mesh.facets.clear();
  mesh.facet_element.clear();
  mesh.facets.reserve(boundary.size() * n);
  mesh.facet_element.reserve(boundary.size());
  for (const std::uint32_t id : boundary) {
    const auto nodes = sets.nodes(id);
    for (std::size_t k = 0; k < n; ++k) mesh.facets.push_back(nodes[k]);
    mesh.facet_element.push_back(static_cast<std::int32_t>(sets.element(id)));
  }
}

void check_mesh(const Mesh& mesh) {
  if (mesh.element_count() == 0) throw InputError("the mesh has no elements");
  check_nodes(mesh);
  check_shapes(mesh);
  const FacetSets sets(mesh);
  sets.visit([&](std::span<const FacetKey> keys) {
    if (keys.size() == 1) return;
    if (keys.size() > 2 || !opposite(sets, keys[0].id, keys[1].id) ||
        !same_midsides(sets, keys[0].id, keys[1].id))
      refuse_side(mesh, sets, keys);
  });
}

MeshPieces connected_pieces(const Mesh& mesh) {
  DisjointSets sets(mesh.node_count());
  const std::size_t n = nodes_per_element(mesh.type);
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t k = 1; k < n; ++k) sets.join(mesh.elements[e * n], mesh.elements[e * n + k]);
  MeshPieces pieces{0, std::vector<std::int32_t>(mesh.node_count(), -1)};
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    std::int32_t& piece = pieces.of_node[sets.find(mesh.elements[e * n])];
    if (piece < 0) piece = pieces.count++;
  }
  for (std::size_t node = 0; node < pieces.of_node.size(); ++node)
    pieces.of_node[node] = pieces.of_node[sets.find(static_cast<std::int32_t>(node))];
  return pieces;
}

}  // namespace kacanov
