// SPDX-License-Identifier: BSD-3-Clause
// The run-time table of cells, built from the cell structs.
#include <kacanov/cells.hpp>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "cells/elements.hpp"

namespace kacanov {
namespace {

using elements::Bodies;
using elements::Others;

/// `rows` padded by zeros.
template <std::size_t dim, std::size_t rows>
constexpr auto padded(const std::array<std::array<double, dim>, rows>& from) {
  std::array<std::array<double, 3>, rows> to{};
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < dim; ++k) to[i][k] = from[i][k];
  return to;
}

template <std::size_t width, std::size_t rows>
constexpr auto in_a_row(const std::array<std::array<std::int8_t, width>, rows>& from) {
  std::array<std::int8_t, width * rows> to{};
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i / width][i % width];
  return to;
}

/// Arrays that the struct stores in another form than the table; empty if it has none.
template <class E>
struct Arrays {
  static constexpr auto reference = [] {
    if constexpr (requires { E::node(); })
      return padded(E::node());
    else
      return std::array<std::array<double, 3>, 0>{};
  }();
  static constexpr auto points = [] {
    if constexpr (requires { E::point; })
      return padded(E::point);
    else
      return std::array<std::array<double, 3>, 0>{};
  }();
  static constexpr auto facet_nodes = [] {
    if constexpr (requires { E::facet; })
      return in_a_row(E::facet);
    else
      return std::array<std::int8_t, 0>{};
  }();
  static constexpr auto box = [] {
    if constexpr (requires { E::box(); })
      return E::box();
    else
      return std::array<elements::Triple, 0>{};
  }();
};

template <class E>
void copy_values(const double* xi, double* n) {
  std::ranges::copy(E::values(xi), n);
}

template <class E>
void copy_gradients(const double* xi, double* d) {
  std::ranges::copy(E::gradients(xi), d);
}

/// Index of E in the table.
template <class E, std::size_t i = 0>
constexpr std::size_t place() {
  using Cells = decltype(std::tuple_cat(Bodies{}, Others{}));
  if constexpr (std::is_same_v<E, std::tuple_element_t<i, Cells>>)
    return i;
  else
    return place<E, i + 1>();
}

template <class E>
constexpr Cell make() {
  static_assert(E::nodes <= static_cast<int>(most_nodes));
  Cell c{};
  c.facet_place = -1;
  c.name = E::name, c.basix = E::basix;
  c.gmsh = E::gmsh, c.vtk = E::vtk;
  c.dim = E::dim, c.order = E::order, c.nodes = E::nodes, c.corners = E::corners;
  c.reference = Arrays<E>::reference, c.points = Arrays<E>::points;
  c.facet_nodes = Arrays<E>::facet_nodes, c.box = Arrays<E>::box;
  c.vtk_order = c.basix_order = elements::in_order<E::nodes>;
  if constexpr (requires { E::vtk_order; }) c.vtk_order = E::vtk_order;
  if constexpr (requires { E::basix_order; }) c.basix_order = E::basix_order;
  if constexpr (requires { E::edge; }) c.edges = E::edge;
  if constexpr (requires { E::triangles; }) c.triangles = E::triangles;
  if constexpr (requires { E::simplex; }) c.simplex = E::simplex;
  if constexpr (requires { E::values(nullptr); }) c.values = copy_values<E>, c.gradients = copy_gradients<E>;
  if constexpr (requires { E::type; }) {
    static_assert(E::Facet::nodes <= static_cast<int>(most_facet_nodes));
    c.abaqus = E::abaqus, c.weight = E::weight, c.mean_dilatation = E::mean_dilatation;
    c.corner_dilatation = E::corner_dilatation;
    c.facet_place = static_cast<int>(place<typename E::Facet>());
  }
  return c;
}

template <class... E, class... F>
constexpr auto make_all(std::tuple<E...>, std::tuple<F...>) {
  return std::array{make<E>()..., make<F>()...};
}
constexpr auto all_cells = make_all(Bodies{}, Others{});

template <class... E>
constexpr auto types_of(std::tuple<E...>) {
  return std::array{E::type...};
}
constexpr auto types = types_of(Bodies{});

}  // namespace

namespace cell_table {

const Cell* const all = all_cells.data();
const std::size_t count = all_cells.size(), bodies = types.size();

void refuse(ElementType type) {
  throw std::invalid_argument("there is no element type " + std::to_string(static_cast<int>(type)));
}

}  // namespace cell_table

std::span<const ElementType> element_types() noexcept { return types; }

std::optional<ElementType> element_type(const Cell& cell) noexcept {
  const std::size_t i = &cell - all_cells.data();
  return i < types.size() ? std::optional(types[i]) : std::nullopt;
}

std::optional<ElementType> element_type(std::string_view name) noexcept {
  for (const ElementType type : types)
    if (cell(type).name == name) return type;
  return std::nullopt;
}

std::string element_names(bool (*wanted)(const Cell&)) {
  std::vector<std::string_view> names;
  for (const ElementType type : types)
    if (wanted(cell(type))) names.push_back(cell(type).name);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + std::string(names[i]);
  return text;
}

std::string bbar_names() {
  return element_names([](const Cell& c) { return c.mean_dilatation; });
}

}  // namespace kacanov
