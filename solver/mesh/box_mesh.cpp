// SPDX-License-Identifier: BSD-3-Clause
// Generated boxes: structured meshes of every element type, with named sides.
#include <algorithm>
#include <cmath>
#include <limits>

#include <kacanov/error.hpp>
#include <kacanov/mesh.hpp>

namespace kacanov {
namespace {

using Index3 = std::array<int, 3>;

/// A lattice of (cells · refinement + 1) points in each direction, x fastest.
struct Lattice {
  std::array<double, 3> size;
  Index3 cells;  ///< after refinement; 0 in directions that do not exist

  std::int32_t node(const Index3& at) const {
    return at[0] + (cells[0] + 1) * (at[1] + (cells[1] + 1) * at[2]);
  }
};

void validate(const BoxSpec& spec) {
  const int dim = dimension(spec.type);
  const int refinement = cell(spec.type).order;
  double nodes = 1, cells = 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k) {
    if (!(spec.size[k] > 0) || !std::isfinite(spec.size[k]))
      throw InputError("box: size[" + std::to_string(k) + "]: expected a number > 0");
    if (spec.cells[k] < 1) throw InputError("box: cells[" + std::to_string(k) + "]: expected an integer ≥ 1");
    nodes *= static_cast<double>(spec.cells[k]) * refinement + 1;
    cells *= spec.cells[k];
  }
  // Unknowns, elements and the facets of all elements must fit the index types used later.
  const double per_cell = cell(spec.type).box_elements();
  const double sides = cells * per_cell * facets_per_element(spec.type);
  if (nodes * dim > std::numeric_limits<std::int32_t>::max() ||
      cells * per_cell > std::numeric_limits<std::int32_t>::max() ||
      sides > std::numeric_limits<std::uint32_t>::max())
    throw InputError("box: so many cells give more unknowns or elements than 32-bit indices can number");
}

void add_nodes(const Lattice& lattice, int dim, std::vector<double>& coordinates) {
  const auto position = [&](int i, std::size_t k) {
    return i == lattice.cells[k] ? lattice.size[k] : lattice.size[k] * i / lattice.cells[k];
  };
  coordinates.reserve((static_cast<std::size_t>(lattice.cells[0]) + 1) *
                      (static_cast<std::size_t>(lattice.cells[1]) + 1) *
                      (static_cast<std::size_t>(lattice.cells[2]) + 1) * static_cast<std::size_t>(dim));
  for (int z = 0; z <= lattice.cells[2]; ++z)
    for (int y = 0; y <= lattice.cells[1]; ++y)
      for (int x = 0; x <= lattice.cells[0]; ++x) {
        coordinates.push_back(position(x, 0));
        coordinates.push_back(position(y, 1));
        if (dim == 3) coordinates.push_back(position(z, 2));
      }
}

/// Appends the elements of the box cell with lowest lattice point `at`.
void add_cell(const Lattice& lattice, const Index3& at, const Cell& type,
              std::vector<std::int32_t>& elements) {
  const std::size_t corners = type.corners;
  for (std::size_t first = 0; first < type.box.size(); first += corners) {
    const auto corner = type.box.subspan(first, corners);
    // With mid-side nodes, lattice points are half an edge apart.
    const auto node = [&](std::int8_t a, std::int8_t b) {
      Index3 place = at;
      for (std::size_t k = 0; k < 3; ++k) place[k] += type.order * (corner[a][k] + corner[b][k]) / 2;
      return lattice.node(place);
    };
    for (std::int8_t a = 0; a < type.corners; ++a) elements.push_back(node(a, a));
    for (const CellEdge& edge : type.edges)
      if (edge.middle >= 0) elements.push_back(node(edge.a, edge.b));
  }
}

void add_elements(const Lattice& lattice, const Index3& cells, ElementType type,
                  std::vector<std::int32_t>& elements) {
  const Cell& facts = cell(type);
  const int step = facts.order;
  const int layers = std::max(cells[2], 1);
  elements.reserve(static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
                   static_cast<std::size_t>(layers) * static_cast<std::size_t>(facts.box_elements()) *
                   static_cast<std::size_t>(facts.nodes));
  for (int z = 0; z < layers; ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x) add_cell(lattice, {x * step, y * step, z * step}, facts, elements);
}

/// The two sides of the box in each direction: low end, high end.
using Sides = std::vector<std::array<Group, 2>>;

Sides named_sides(std::size_t dim) {
  constexpr std::array<std::array<const char*, 2>, 3> names3{
      {{"left", "right"}, {"front", "back"}, {"bottom", "top"}}};
  constexpr std::array<std::array<const char*, 2>, 2> names2{{{"left", "right"}, {"bottom", "top"}}};
  Sides sides(dim);
  for (std::size_t k = 0; k < dim; ++k)
    for (std::size_t end = 0; end < 2; ++end) {
      sides[k][end].name = dim == 3 ? names3[k][end] : names2[k][end];
      sides[k][end].dimension = static_cast<int>(dim) - 1;
    }
  return sides;
}

/// Adds the facets of the elements of box cell `at` that lie on the sides, as find_boundary() would.
void add_facets(const Index3& cells, const Index3& at, Mesh& mesh, Sides& sides, std::size_t first_element) {
  const Cell& type = cell(mesh.type);
  const std::size_t facet_nodes = type.facet().nodes, facet_corners = type.facet().corners;
  for (std::size_t e = 0; e < static_cast<std::size_t>(type.box_elements()); ++e)
    for (std::size_t f = 0; f < type.facet_nodes.size(); f += facet_nodes) {
      const auto nodes = type.facet_nodes.subspan(f, facet_nodes);
      for (std::size_t k = 0; k < sides.size(); ++k)
        for (const int end : {0, 1}) {
          if (at[k] != end * (cells[k] - 1)) continue;
          const auto on_side = [&](std::int8_t corner) {
            return type.box[e * static_cast<std::size_t>(type.corners) + static_cast<std::size_t>(corner)]
                           [k] == end;
          };
          if (!std::all_of(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(facet_corners),
                           on_side))
            continue;
          sides[k][static_cast<std::size_t>(end)].members.push_back(
              static_cast<std::int32_t>(mesh.facet_count()));
          mesh.facet_element.push_back(static_cast<std::int32_t>(first_element + e));
          for (const std::int8_t node : nodes)
            mesh.facets.push_back(mesh.elements[(first_element + e) * static_cast<std::size_t>(type.nodes) +
                                                static_cast<std::size_t>(node)]);
        }
    }
}

void add_boundary(const Index3& cells, Mesh& mesh) {
  Sides sides = named_sides(static_cast<std::size_t>(mesh.dim()));
  const auto is_outer = [&](const Index3& at) {
    for (std::size_t k = 0; k < sides.size(); ++k)
      if (at[k] == 0 || at[k] == cells[k] - 1) return true;
    return false;
  };
  std::size_t element = 0;
  for (int z = 0; z < std::max(cells[2], 1); ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x) {
        if (is_outer({x, y, z})) add_facets(cells, {x, y, z}, mesh, sides, element);
        element += static_cast<std::size_t>(cell(mesh.type).box_elements());
      }
  for (auto& ends : sides)
    for (Group& side : ends) mesh.groups.push_back(std::move(side));
}

}  // namespace

Mesh make_box(const BoxSpec& spec) {
  validate(spec);
  Mesh mesh;
  mesh.type = spec.type;
  const int dim = mesh.dim();
  const int refinement = cell(spec.type).order;
  Index3 cells = spec.cells;
  if (dim == 2) cells[2] = 0;
  const Lattice lattice{spec.size, {cells[0] * refinement, cells[1] * refinement, cells[2] * refinement}};
  add_nodes(lattice, dim, mesh.coordinates);
  add_elements(lattice, cells, spec.type, mesh.elements);
  add_boundary(cells, mesh);
  return mesh;
}

}  // namespace kacanov
