// SPDX-License-Identifier: BSD-3-Clause
// The element types: names, nodes, facets, shape functions and quadrature of each, their list, and the
// dispatch from a run-time type to its struct.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include <kacanov/cells.hpp>

namespace kacanov::elements {

using Triple = std::array<std::int8_t, 3>;

/// The identity permutation of the nodes.
template <int nodes>
inline constexpr auto in_order = [] {
  std::array<std::int8_t, nodes> order{};
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::int8_t>(k);
  return order;
}();

/// ∂Lₐ/∂ξ_k of the barycentric coordinates L₀ = 1 − Σ ξ_k, L_k = ξ_{k−1}.
constexpr double barycentric_slope(std::size_t a, std::size_t k) {
  return a == 0 ? -1.0 : a == k + 1 ? 1.0 : 0.0;
}

template <std::size_t dim>
constexpr std::array<double, dim + 1> barycentric(const double* xi) {
  std::array<double, dim + 1> l{1.0};
  for (std::size_t k = 0; k < dim; ++k) l[0] -= xi[k];
  for (std::size_t k = 0; k < dim; ++k) l[k + 1] = xi[k];
  return l;
}

template <std::size_t dim>
constexpr std::array<double, (dim + 1) * dim> barycentric_slopes() {
  std::array<double, (dim + 1) * dim> d{};
  for (std::size_t a = 0; a <= dim; ++a)
    for (std::size_t k = 0; k < dim; ++k) d[a * dim + k] = barycentric_slope(a, k);
  return d;
}

/// Lₐ(2Lₐ − 1) at the corners, 4 LₐL_b at the midpoint of edge ab.
template <class E>
constexpr std::array<double, E::nodes> quadratic_values(const double* xi) {
  const auto l = barycentric<E::dim>(xi);
  std::array<double, E::nodes> n{};
  for (std::size_t a = 0; a < E::corners; ++a) n[a] = l[a] * (2.0 * l[a] - 1.0);
  for (const CellEdge& e : E::edge) n[e.middle] = 4.0 * l[e.a] * l[e.b];
  return n;
}

template <class E>
constexpr std::array<double, E::nodes * E::dim> quadratic_gradients(const double* xi) {
  constexpr std::size_t dim = E::dim;
  const auto l = barycentric<dim>(xi);
  std::array<double, E::nodes * dim> d{};
  for (std::size_t k = 0; k < dim; ++k) {
    for (std::size_t a = 0; a < E::corners; ++a)
      d[dim * a + k] = (4.0 * l[a] - 1.0) * barycentric_slope(a, k);
    for (const CellEdge& e : E::edge) {
      const std::size_t a = e.a, b = e.b;
      d[dim * e.middle + k] = 4.0 * (l[a] * barycentric_slope(b, k) + l[b] * barycentric_slope(a, k));
    }
  }
  return d;
}

/// Corners at the origin and the unit points, then the midpoints of the edges.
template <class E>
constexpr std::array<std::array<double, E::dim>, E::nodes> simplex_nodes() {
  std::array<std::array<double, E::dim>, E::nodes> x{};
  for (std::size_t k = 0; k < E::dim; ++k) x[k + 1][k] = 1.0;
  for (const CellEdge& e : E::edge)
    for (std::size_t k = 0; e.middle >= 0 && k < E::dim; ++k) x[e.middle][k] = 0.5 * (x[e.a][k] + x[e.b][k]);
  return x;
}

}  // namespace kacanov::elements

namespace kacanov::elements {

inline constexpr double gauss2 = 0.57735026918962576;  ///< 1/√3

/// Π (1 + c_k ξ_k)/2 with the coordinates c of each corner.
template <class E>
constexpr std::array<double, E::nodes> tensor_values(const double* xi) {
  std::array<double, E::nodes> n{};
  for (std::size_t a = 0; a < E::nodes; ++a) {
    n[a] = 1.0 / E::nodes;
    for (std::size_t k = 0; k < E::dim; ++k) n[a] *= 1 + E::corner[a][k] * xi[k];
  }
  return n;
}

template <class E>
constexpr std::array<double, E::nodes * E::dim> tensor_gradients(const double* xi) {
  std::array<double, E::nodes * E::dim> d{};
  for (std::size_t a = 0; a < E::nodes; ++a)
    for (std::size_t k = 0; k < E::dim; ++k) {
      double slope = 1.0 / E::nodes * E::corner[a][k];
      for (std::size_t l = 0; l < E::dim; ++l)
        if (l != k) slope *= 1 + E::corner[a][l] * xi[l];
      d[E::dim * a + k] = slope;
    }
  return d;
}

/// The corners, scaled towards the centre by `factor`.
template <class E>
constexpr std::array<std::array<double, E::dim>, E::nodes> tensor_points(double factor) {
  std::array<std::array<double, E::dim>, E::nodes> p{};
  for (std::size_t a = 0; a < E::nodes; ++a)
    for (std::size_t k = 0; k < E::dim; ++k) p[a][k] = factor * E::corner[a][k];
  return p;
}

/// The unit cell as one element.
template <class E>
constexpr std::array<Triple, E::nodes> whole_box() {
  std::array<Triple, E::nodes> at{};
  for (std::size_t a = 0; a < E::nodes; ++a)
    for (std::size_t k = 0; k < E::dim; ++k) at[a][k] = E::corner[a][k] > 0 ? 1 : 0;
  return at;
}

}  // namespace kacanov::elements

namespace kacanov::elements {

struct Point1 {
  static constexpr std::string_view name = "point", basix = "point";
  static constexpr int gmsh = 15, vtk = 1, dim = 0, order = 0, nodes = 1, corners = 1;
};

struct Line2 {
  static constexpr std::string_view name = "line2", basix = "interval";
  static constexpr int gmsh = 1, vtk = 3, dim = 1, order = 1, nodes = 2, corners = 2;
  static constexpr bool simplex = false;
  static constexpr std::array<std::array<int, 1>, 2> corner{{{-1}, {1}}};
  static constexpr std::array<CellEdge, 1> edge{{{0, 1}}};
  /// Shape functions at ξ.
  static constexpr std::array<double, 2> values(const double* xi) { return tensor_values<Line2>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 2> gradients(const double* xi) { return tensor_gradients<Line2>(xi); }
  static constexpr auto node() { return tensor_points<Line2>(1.0); }
};

/// Boundary of flat pieces in files of quadratic tetrahedra; only its node count matters.
struct Line3 {
  static constexpr std::string_view name = "line3", basix = "interval";
  static constexpr int gmsh = 8, vtk = 21, dim = 1, order = 2, nodes = 3, corners = 2;
};

}  // namespace kacanov::elements

namespace kacanov::elements {

struct Tri3 {
  static constexpr ElementType type = ElementType::tri3;
  static constexpr std::string_view name = "tri3", abaqus = "CPE3", basix = "triangle";
  static constexpr int gmsh = 2, vtk = 5, dim = 2, order = 1, nodes = 3, corners = 3, points = 1;
  static constexpr bool simplex = true, mean_dilatation = false, corner_dilatation = false;
  static constexpr std::array<CellEdge, 3> edge{{{0, 1}, {1, 2}, {2, 0}}};
  static constexpr std::array<Triple, 1> triangles{{{0, 1, 2}}};
  using Facet = Line2;
  static constexpr std::array<std::array<std::int8_t, 2>, 3> facet{{{0, 1}, {1, 2}, {2, 0}}};
  static constexpr std::array<std::array<double, 2>, 1> point{{{1.0 / 3.0, 1.0 / 3.0}}};
  static constexpr double weight = 0.5;  ///< of each point, on the reference element
  /// The square, split from lower left to upper right.
  static constexpr std::array<Triple, 6> box() { return {{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}}; }

  /// Shape functions at ξ.
  static constexpr std::array<double, 3> values(const double* xi) { return barycentric<2>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 6> gradients(const double*) { return barycentric_slopes<2>(); }
  static constexpr auto node() { return simplex_nodes<Tri3>(); }
};

}  // namespace kacanov::elements

namespace kacanov::elements {

struct Quad4 {
  static constexpr ElementType type = ElementType::quad4;
  static constexpr std::string_view name = "quad4", abaqus = "CPE4", basix = "quadrilateral";
  static constexpr int gmsh = 3, vtk = 9, dim = 2, order = 1, nodes = 4, corners = 4, points = 4;
  static constexpr bool simplex = false, mean_dilatation = true, corner_dilatation = false;
  static constexpr std::array<std::array<int, 2>, 4> corner{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  static constexpr std::array<CellEdge, 4> edge{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  static constexpr std::array<std::int8_t, 4> basix_order{0, 1, 3, 2};
  static constexpr std::array<Triple, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  using Facet = Line2;
  static constexpr std::array<std::array<std::int8_t, 2>, 4> facet{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  static constexpr double weight = 1.0;  ///< of each point
  /// Point i lies next to corner i.
  static constexpr std::array<std::array<double, 2>, 4> point{
      {{-gauss2, -gauss2}, {gauss2, -gauss2}, {gauss2, gauss2}, {-gauss2, gauss2}}};
  /// Shape functions at ξ.
  static constexpr std::array<double, 4> values(const double* xi) { return tensor_values<Quad4>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 8> gradients(const double* xi) { return tensor_gradients<Quad4>(xi); }
  static constexpr auto node() { return tensor_points<Quad4>(1.0); }
  static constexpr auto box() { return whole_box<Quad4>(); }
};

}  // namespace kacanov::elements

namespace kacanov::elements {

struct Tri6 {
  static constexpr std::string_view name = "tri6", basix = "triangle";
  static constexpr int gmsh = 9, vtk = 22, dim = 2, order = 2, nodes = 6, corners = 3;
  static constexpr bool simplex = true;
  static constexpr std::array<CellEdge, 3> edge{{{0, 1, 3}, {1, 2, 4}, {2, 0, 5}}};
  static constexpr std::array<std::int8_t, 6> basix_order{0, 1, 2, 4, 5, 3};
  static constexpr std::array<Triple, 4> triangles{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  /// Shape functions at ξ.
  static constexpr std::array<double, 6> values(const double* xi) { return quadratic_values<Tri6>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 12> gradients(const double* xi) {
    return quadratic_gradients<Tri6>(xi);
  }
  static constexpr auto node() { return simplex_nodes<Tri6>(); }
};

}  // namespace kacanov::elements

namespace kacanov::elements {

/// The cube as six tetrahedra around its diagonal from the lowest to the highest corner, one per path along
/// the axes between these corners; for odd permutations two corners are swapped to keep the orientation.
inline constexpr std::array<Triple, 24> six_tetrahedra = [] {
  constexpr std::size_t path[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  std::array<Triple, 24> corners{};
  for (std::size_t p = 0; p < 6; ++p) {
    Triple* corner = corners.data() + 4 * p;
    for (std::size_t s = 0; s < 3; ++s) {
      corner[s + 1] = corner[s];
      corner[s + 1][path[p][s]] = 1;
    }
    if (p >= 3) std::swap(corner[2], corner[3]);
  }
  return corners;
}();

struct Tet4 {
  static constexpr ElementType type = ElementType::tet4;
  static constexpr std::string_view name = "tet4", abaqus = "C3D4", basix = "tetrahedron";
  static constexpr int gmsh = 4, vtk = 10, dim = 3, order = 1, nodes = 4, corners = 4, points = 1;
  static constexpr bool simplex = true, mean_dilatation = false, corner_dilatation = true;
  static constexpr std::array<CellEdge, 6> edge{{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
  using Facet = Tri3;
  static constexpr std::array<std::array<std::int8_t, 3>, 4> facet{
      {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  static constexpr std::array<std::array<double, 3>, 1> point{{{0.25, 0.25, 0.25}}};
  static constexpr double weight = 1.0 / 6.0;  ///< of each point, on the reference element
  static constexpr auto box() { return six_tetrahedra; }

  /// Shape functions at ξ.
  static constexpr std::array<double, 4> values(const double* xi) { return barycentric<3>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 12> gradients(const double*) { return barycentric_slopes<3>(); }
  static constexpr auto node() { return simplex_nodes<Tet4>(); }
};

}  // namespace kacanov::elements

namespace kacanov::elements {

struct Tet10 {
  static constexpr ElementType type = ElementType::tet10;
  static constexpr std::string_view name = "tet10", abaqus = "C3D10", basix = "tetrahedron";
  static constexpr int gmsh = 11, vtk = 24, dim = 3, order = 2, nodes = 10, corners = 4, points = 4;
  static constexpr bool simplex = true, mean_dilatation = false, corner_dilatation = true;
  static constexpr std::array<CellEdge, 6> edge{
      {{0, 1, 4}, {1, 2, 5}, {2, 0, 6}, {3, 0, 7}, {3, 2, 8}, {3, 1, 9}}};
  /// VTK swaps the midpoints of the edges 13 and 23.
  static constexpr std::array<std::int8_t, 10> vtk_order{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
  static constexpr std::array<std::int8_t, 10> basix_order{0, 1, 2, 3, 8, 9, 5, 7, 6, 4};
  using Facet = Tri6;
  static constexpr std::array<std::array<std::int8_t, 6>, 4> facet{
      {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {0, 3, 2, 7, 8, 6}, {1, 2, 3, 5, 8, 9}}};
  static constexpr double far = 0.13819660112501052;   ///< (5 − √5)/20
  static constexpr double near = 0.58541019662496845;  ///< (5 + 3√5)/20
  /// Point i lies next to vertex i: barycentric coordinate `near` there, `far` at the others.
  static constexpr std::array<std::array<double, 3>, 4> point{
      {{far, far, far}, {near, far, far}, {far, near, far}, {far, far, near}}};
  static constexpr double weight = 1.0 / 24.0;  ///< of each point, on the reference element
  static constexpr auto box() { return six_tetrahedra; }

  /// Shape functions at ξ.
  static constexpr std::array<double, 10> values(const double* xi) { return quadratic_values<Tet10>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 30> gradients(const double* xi) {
    return quadratic_gradients<Tet10>(xi);
  }
  static constexpr auto node() { return simplex_nodes<Tet10>(); }
};

}  // namespace kacanov::elements

namespace kacanov::elements {

struct Hex8 {
  static constexpr ElementType type = ElementType::hex8;
  static constexpr std::string_view name = "hex8", abaqus = "C3D8", basix = "hexahedron";
  static constexpr int gmsh = 5, vtk = 12, dim = 3, order = 1, nodes = 8, corners = 8, points = 8;
  static constexpr bool simplex = false, mean_dilatation = true, corner_dilatation = false;
  /// Corners of the reference element [-1, 1]³ in node order.
  static constexpr std::array<std::array<int, 3>, 8> corner{
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  static constexpr std::array<CellEdge, 12> edge{
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
  static constexpr std::array<std::int8_t, 8> basix_order{0, 1, 3, 2, 4, 5, 7, 6};
  using Facet = Quad4;
  static constexpr std::array<std::array<std::int8_t, 4>, 6> facet{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}}};
  static constexpr double gauss = gauss2;
  static constexpr double weight = 1.0;  ///< of each point
  /// Point i lies next to corner i.
  static constexpr auto point = [] {
    std::array<std::array<double, 3>, 8> p{};
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t k = 0; k < 3; ++k) p[i][k] = gauss * corner[i][k];
    return p;
  }();

  /// Shape functions at ξ.
  static constexpr std::array<double, 8> values(const double* xi) { return tensor_values<Hex8>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 24> gradients(const double* xi) { return tensor_gradients<Hex8>(xi); }
  static constexpr auto node() { return tensor_points<Hex8>(1.0); }
  static constexpr auto box() { return whole_box<Hex8>(); }
};

}  // namespace kacanov::elements

namespace kacanov::elements {

/// Cells of bodies, in the order of ElementType.
using Bodies = std::tuple<Tri3, Tet4, Tet10, Hex8, Quad4>;
/// Other cells in mesh files.
using Others = std::tuple<Point1, Line2, Line3, Tri6>;

/// Calls `function(E{})` with the struct of `type`. Throws std::invalid_argument for an invalid number.
template <std::size_t i = 0, class Function>
decltype(auto) dispatch(ElementType type, Function&& function) {
  using E = std::tuple_element_t<i, Bodies>;
  static_assert(E::type == static_cast<ElementType>(i), "Bodies and ElementType differ in their order");
  if constexpr (i + 1 < std::tuple_size_v<Bodies>) {
    if (type != E::type) return dispatch<i + 1>(type, std::forward<Function>(function));
  } else if (type != E::type) {
    cell_table::refuse(type);
  }
  return function(E{});
}

}  // namespace kacanov::elements
