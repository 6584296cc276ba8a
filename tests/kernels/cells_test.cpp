// SPDX-License-Identifier: BSD-3-Clause
// The table of cells against the conventions of other programs and against geometry; maps from the reference
// element; folded elements.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <kacanov/cells.hpp>
#include "operator/element_maps.hpp"

using namespace kacanov;

namespace {

using Position = std::array<double, 3>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Returns Σ N_a(ξ) x_a for the node coordinates `nodes`.
Position interpolate(const Cell& cell, const Position& xi, std::span<const Position> nodes) {
  std::array<double, most_nodes> n{};
  cell.values(xi.data(), n.data());
  Position x{};
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t k = 0; k < 3; ++k) x[k] += n[a] * nodes[a][k];
  return x;
}

/// Returns the columns ∂x/∂ξ_k of the map's Jacobian at ξ.
std::array<Position, 3> jacobian(const Cell& cell, const Position& xi, std::span<const Position> nodes) {
  std::array<double, 3 * most_nodes> d{};
  cell.gradients(xi.data(), d.data());
  std::array<Position, 3> j{};
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t k = 0; k < at(cell.dim); ++k)
      for (std::size_t i = 0; i < 3; ++i) j[k][i] += nodes[a][i] * d[a * at(cell.dim) + k];
  return j;
}

Position cross(const Position& a, const Position& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Position& a, const Position& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double distance(const Position& a, const Position& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
Position middle(const Position& a, const Position& b) {
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}
double volume(int dim) { return dim == 2 ? 4.0 : 8.0; }

/// Returns the cells that have shape functions.
std::vector<const Cell*> shaped() {
  std::vector<const Cell*> result;
  for (const Cell& cell : cells())
    if (cell.values != nullptr) result.push_back(&cell);
  return result;
}

}  // namespace

TEST_CASE("names and numbers are those of Gmsh, VTK and Abaqus") {
  struct Known {
    int gmsh, vtk, dim, nodes, corners;
    const char* abaqus;
  };
  const std::map<std::string, Known> known{
      {"point", {15, 1, 0, 1, 1, ""}},    {"line2", {1, 3, 1, 2, 2, ""}},
      {"line3", {8, 21, 1, 3, 2, ""}},    {"tri3", {2, 5, 2, 3, 3, "CPE3"}},
      {"tri6", {9, 22, 2, 6, 3, ""}},     {"quad4", {3, 9, 2, 4, 4, "CPE4"}},
      {"tet4", {4, 10, 3, 4, 4, "C3D4"}}, {"tet10", {11, 24, 3, 10, 4, "C3D10"}},
      {"hex8", {5, 12, 3, 8, 8, "C3D8"}},
  };
  CHECK(cells().size() == known.size());
  for (const Cell& cell : cells()) {
    const std::string name(cell.name);
    CAPTURE(name);
    REQUIRE(known.count(name) == 1);
    const Known& k = known.at(name);
    CHECK(cell.gmsh == k.gmsh);
    CHECK(cell.vtk == k.vtk);
    CHECK(cell.dim == k.dim);
    CHECK(cell.nodes == k.nodes);
    CHECK(cell.corners == k.corners);
    CHECK(cell.abaqus == k.abaqus);
  }
  for (const ElementType type : element_types()) {
    CHECK(element_type(cell(type)) == type);
    CHECK(element_type(cell(type).name) == type);
  }
  CHECK_FALSE(element_type("tri6"));
  CHECK_FALSE(element_type("hex20"));
  CHECK_THROWS_AS(cell(static_cast<ElementType>(200)), std::invalid_argument);
  CHECK(element_names([](const Cell& c) { return c.dim == 3; }) == "tet4, tet10 or hex8");
  CHECK(element_names([](const Cell& c) { return c.dim == 2; }) == "tri3 or quad4");
}

TEST_CASE("every shape function is one at its node and zero at the others") {
  for (const Cell* cell : shaped()) {
    CAPTURE(std::string(cell->name));
    REQUIRE(cell->reference.size() == at(cell->nodes));
    for (std::size_t b = 0; b < cell->reference.size(); ++b) {
      std::array<double, most_nodes> n{};
      cell->values(cell->reference[b].data(), n.data());
      for (std::size_t a = 0; a < cell->reference.size(); ++a)
        CHECK(n[a] == doctest::Approx(a == b ? 1.0 : 0.0));
    }
    for (const CellEdge& edge : cell->edges)
      if (edge.middle >= 0)
        CHECK(distance(cell->reference[edge.middle],
                       middle(cell->reference[edge.a], cell->reference[edge.b])) < 1e-15);
  }
}

TEST_CASE("facets are whole, close the cell and look outwards") {
  for (const ElementType type : element_types()) {
    const Cell& body = cell(type);
    const Cell& facet = body.facet();
    CAPTURE(std::string(body.name));
    CHECK(facet.dim == body.dim - 1);
    Position centre{}, closed{};
    for (const Position& x : body.reference)
      for (std::size_t k = 0; k < 3; ++k) centre[k] += x[k] / body.nodes;
    for (int f = 0; f < body.facets(); ++f) {
      std::vector<Position> nodes;
      for (const std::int8_t a : body.facet_nodes.subspan(at(f * facet.nodes), at(facet.nodes)))
        nodes.push_back(body.reference[a]);
      for (const CellEdge& edge : facet.edges)
        if (edge.middle >= 0)
          CHECK(distance(nodes[edge.middle], middle(nodes[edge.a], nodes[edge.b])) < 1e-15);
      const Position inside = facet.simplex ? Position{1.0 / 3, 1.0 / 3, 0} : Position{};
      const auto j = jacobian(facet, inside, nodes);
      const Position normal = body.dim == 2 ? Position{j[0][1], -j[0][0], 0} : cross(j[0], j[1]);
      const Position x = interpolate(facet, inside, nodes);
      CHECK(dot(normal, {x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]}) > 0.0);
      for (std::size_t k = 0; k < 3; ++k) closed[k] += normal[k];
    }
    for (const double sum : closed) CHECK(sum == doctest::Approx(0.0));
    // Each edge has two facets in 3D and is one facet in 2D.
    for (const CellEdge& edge : body.edges) {
      int meeting = 0;
      for (int f = 0; f < body.facets(); ++f) {
        const auto nodes = body.facet_nodes.subspan(at(f * facet.nodes), at(facet.nodes));
        meeting += std::ranges::count(nodes, edge.a) + std::ranges::count(nodes, edge.b) == 2;
      }
      CHECK(meeting == (body.dim == 2 ? 1 : 2));
    }
  }
}

TEST_CASE("quadrature points lie inside, their weights fill the reference cell, linear functions are exact") {
  for (const ElementType type : element_types()) {
    const Cell& body = cell(type);
    CAPTURE(std::string(body.name));
    const double size = body.simplex ? (body.dim == 2 ? 0.5 : 1.0 / 6.0) : volume(body.dim);
    CHECK(body.weight * static_cast<double>(body.points.size()) == doctest::Approx(size));
    for (std::size_t k = 0; k < at(body.dim); ++k) {
      double mean = 0.0;
      for (const Position& point : body.points) mean += point[k] / static_cast<double>(body.points.size());
      CHECK(mean == doctest::Approx(body.simplex ? 1.0 / (body.dim + 1) : 0.0));
    }
  }
}

TEST_CASE("a box is cut into elements that turn the right way and fill it") {
  for (const ElementType type : element_types()) {
    const Cell& body = cell(type);
    CAPTURE(std::string(body.name));
    double sum = 0.0;
    for (int e = 0; e < body.box_elements(); ++e) {
      std::vector<Position> nodes;
      for (const auto& corner : body.box.subspan(at(e * body.corners), at(body.corners)))
        nodes.push_back({double(corner[0]), double(corner[1]), double(corner[2])});
      for (const CellEdge& edge : body.edges)
        if (edge.middle >= 0) nodes.push_back(middle(nodes[edge.a], nodes[edge.b]));
      for (const Position& point : body.points) {
        auto j = jacobian(body, point, nodes);
        if (body.dim == 2) j[2] = {0, 0, 1};
        const double det = dot(j[0], cross(j[1], j[2]));
        CHECK(det > 0.0);
        sum += body.weight * det;
      }
    }
    CHECK(sum == doctest::Approx(1.0));
  }
}

TEST_CASE("triangles cover flat cells") {
  for (const Cell* flat : shaped()) {
    if (flat->dim != 2) continue;
    CAPTURE(std::string(flat->name));
    double sum = 0.0;
    for (const auto& t : flat->triangles) {
      const Position &a = flat->reference[t[0]], &b = flat->reference[t[1]], &c = flat->reference[t[2]];
      const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
      CHECK(twice > 0.0);
      sum += 0.5 * twice;
    }
    CHECK(sum == doctest::Approx(flat->simplex ? 0.5 : 4.0));
  }
}

TEST_CASE("nodes in the orders of VTK and Basix") {
  for (const Cell& cell : cells())
    for (const auto order : {cell.vtk_order, cell.basix_order}) {
      std::vector<std::int8_t> sorted(order.begin(), order.end());
      std::sort(sorted.begin(), sorted.end());
      REQUIRE(sorted.size() == at(cell.nodes));
      for (std::size_t k = 0; k < sorted.size(); ++k) CHECK(sorted[k] == static_cast<std::int8_t>(k));
    }
  // For mid-edge nodes VTK and Basix both name edges by their end nodes; Basix orders the edges from the last
  // corners.
  struct Edges {
    ElementType type;
    std::vector<std::array<int, 2>> vtk, basix;
  };
  const std::vector<Edges> quadratic{{ElementType::tet10,
                                      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
                                      {{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}}}};
  for (const auto& [type, vtk, basix] : quadratic) {
    const Cell& body = cell(type);
    for (std::size_t e = 0; e < vtk.size(); ++e) {
      const auto corner = [&](int a) { return body.reference[a]; };
      CHECK(distance(body.reference[body.vtk_order[4 + e]], middle(corner(vtk[e][0]), corner(vtk[e][1]))) ==
            0.0);
      CHECK(distance(body.reference[body.basix_order[4 + e]],
                     middle(corner(basix[e][0]), corner(basix[e][1]))) == 0.0);
    }
  }
  // Basix numbers the nodes of tensor-product cells with the first coordinate running fastest.
  for (const Cell* cell : shaped()) {
    if (cell->simplex) continue;
    for (std::size_t k = 0; k < at(cell->nodes); ++k)
      for (std::size_t c = 0; c < at(cell->dim); ++c)
        CHECK(cell->reference[at(cell->basix_order[k])][c] == ((k >> c & 1) != 0 ? 1.0 : -1.0));
  }
}

namespace {

constexpr ElementType every_type[] = {ElementType::tri3, ElementType::quad4, ElementType::tet4,
                                      ElementType::tet10, ElementType::hex8};

/// Elements that share no nodes: each is the reference element with its nodes moved by `map(element, node)`.
struct Elements {
  std::vector<double> coordinates;
  std::vector<std::int32_t> connectivity;
  ElementType type;

  template <class Map>
  Elements(ElementType of, std::size_t count, const Map& map) : type(of) {
    const Cell& cell = kacanov::cell(of);
    for (std::size_t e = 0; e < count; ++e)
      for (const auto& at : cell.reference) {
        connectivity.push_back(static_cast<std::int32_t>(connectivity.size()));
        const auto x = map(e, at);
        coordinates.insert(coordinates.end(), x.begin(), x.begin() + cell.dim);
      }
  }
  MeshView view() const { return {type, coordinates, connectivity, PlaneState::strain}; }
};

}  // namespace

TEST_CASE("batched maps are those of one element after the other") {
  for (const ElementType type : every_type)
    for (const std::size_t count : {std::size_t{1}, std::size_t{16}, std::size_t{37}}) {
      CAPTURE(cell(type).name);
      CAPTURE(count);
      std::minstd_rand draw;
      std::uniform_real_distribution<double> some(-0.3, 0.3);
      const Elements elements(type, count, [&](std::size_t, std::array<double, 3> x) {
        for (double& one : x) one += some(draw);
        return x;
      });
      std::size_t seen = 0;
      visit_element_maps(elements.view(), [&](std::size_t first, std::span<const ElementMap> maps) {
        CHECK(first == seen);
        for (const ElementMap& map : maps) {
          const ElementMap expected = element_map(elements.view(), seen++);
          CHECK(map.volume == doctest::Approx(expected.volume).epsilon(1e-12));
          CHECK(map.least_det == doctest::Approx(expected.least_det).epsilon(1e-12));
          CHECK(map.most_det == doctest::Approx(expected.most_det).epsilon(1e-12));
          CHECK(map.thinness == doctest::Approx(expected.thinness).epsilon(1e-12));
        }
      });
      CHECK(seen == count);
    }
}

TEST_CASE("squeezed, turned round and overflowing elements show it") {
  for (const ElementType type : every_type) {
    CAPTURE(cell(type).name);
    const int dim = cell(type).dim;
    const double whole = cell(type).weight * static_cast<double>(cell(type).points.size());
    for (const double size : {1e-30, 1.0, 1e30})
      for (const double squeeze : {1.0, 1e-4, -1.0, 0.0}) {
        CAPTURE(size);
        CAPTURE(squeeze);
        const Elements elements(type, 3, [&](std::size_t, std::array<double, 3> x) {
          for (double& one : x) one *= size;
          x[0] *= squeeze;
          return x;
        });
        visit_element_maps(elements.view(), [&](std::size_t, std::span<const ElementMap> maps) {
          for (const ElementMap& map : maps) {
            const double det = squeeze * std::pow(size, dim);
            CHECK(map.volume == doctest::Approx(whole * det).epsilon(1e-12));
            CHECK(map.least_det == doctest::Approx(det).epsilon(1e-12));
            CHECK(map.most_det == doctest::Approx(det).epsilon(1e-12));
            if (squeeze == 1.0 || squeeze == -1.0)
              CHECK(map.thinness == doctest::Approx(squeeze));
            else if (squeeze == 0.0)
              CHECK(map.thinness == 0.0);
            else
              CHECK((map.thinness > squeeze && map.thinness < 3.0 * squeeze));
          }
        });
      }
    const Elements huge(type, 1, [](std::size_t, std::array<double, 3> x) {
      for (double& one : x) one *= 1e200;
      return x;
    });
    CHECK(element_map(huge.view(), 0).thinness == 0.0);
    visit_element_maps(huge.view(),
                       [](std::size_t, std::span<const ElementMap> maps) { CHECK(maps[0].thinness == 0.0); });
  }
}

namespace {

struct OneElement {
  ElementType type;
  std::vector<double> coordinates;
  std::vector<std::int32_t> connectivity;

  explicit OneElement(ElementType of) : type(of) {
    for (const auto& at : cell(of).reference) {
      coordinates.insert(coordinates.end(), at.begin(), at.begin() + cell(of).dim);
      connectivity.push_back(static_cast<std::int32_t>(connectivity.size()));
    }
  }
  MeshView view() const { return {type, coordinates, connectivity, PlaneState::strain}; }

  double det_at(const std::array<double, 3>& xi) const {
    const Cell& c = cell(type);
    std::array<double, 3 * most_nodes> slopes{};
    c.gradients(xi.data(), slopes.data());
    std::array<std::array<double, 3>, 3> j{};
    if (c.dim == 2) j[2][2] = 1.0;
    const std::size_t dim = c.dim;
    for (std::size_t a = 0; a < static_cast<std::size_t>(c.nodes); ++a)
      for (std::size_t k = 0; k < dim; ++k)
        for (std::size_t i = 0; i < dim; ++i) j[k][i] += coordinates[a * dim + i] * slopes[a * dim + k];
    return j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) -
           j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
           j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
  }
};

struct Sampled {
  double least = HUGE_VAL, most = -HUGE_VAL;
  bool at_corner = false;  ///< the minimum is attained at a corner
};

/// Samples det J on a grid over the reference element, corners and edges included.
Sampled sample(const OneElement& element) {
  constexpr int cells = 12;
  const Cell& c = cell(element.type);
  Sampled out;
  double corners = HUGE_VAL;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= (c.simplex ? cells - i : cells); ++j)
      for (int k = 0; k <= (c.dim == 2 ? 0 : c.simplex ? cells - i - j : cells); ++k) {
        std::array<double, 3> xi{1.0 * i / cells, 1.0 * j / cells, 1.0 * k / cells};
        if (!c.simplex)
          for (double& one : xi) one = 2.0 * one - 1.0;
        const double det = element.det_at(xi);
        out.least = std::min(out.least, det);
        out.most = std::max(out.most, det);
        const auto end = [](int n) { return n == 0 || n == cells; };
        if (end(i) && end(j) && end(k)) corners = std::min(corners, det);
      }
  out.at_corner = corners <= out.least;
  return out;
}

bool is_folded(const OneElement& element) { return find_negative_jacobian(element.view(), 0).has_value(); }

}  // namespace

TEST_CASE("an element is folded exactly where some sample of its Jacobian is negative") {
  std::mt19937 bits(47);
  std::uniform_real_distribution<double> some(-1.0, 1.0);
  for (const ElementType type : {ElementType::quad4, ElementType::tet10, ElementType::hex8}) {
    int folded = 0, valid = 0, unseen_by_points = 0, unseen_by_corners = 0;
    for (int trial = 0; trial < 4000; ++trial) {
      OneElement element(type);
      const double size = (type == ElementType::tet10 ? 0.2 : 1.6) * std::abs(some(bits));
      for (double& x : element.coordinates) x += size * some(bits);
      const Sampled seen = sample(element);
      const bool found = is_folded(element);
      // Samples can miss a negative det J between them, so a negative sample implies a folded element, not
      // vice versa.
      if (seen.least < -1e-6 * seen.most) {
        REQUIRE(found);
        ++folded;
        if (element_map(element.view(), 0).least_det > 0.0) ++unseen_by_points;
        if (!seen.at_corner) ++unseen_by_corners;
      } else if (!found) {
        ++valid;
      }
      // Curved, but det J stays well above 0 between the samples too: the check must accept the element.
      if (seen.least > 0.2 * seen.most) CHECK_FALSE(found);
    }
    CAPTURE(cell(type).name);
    CHECK(folded > 300);
    CHECK(valid > 300);
    CHECK(unseen_by_points > 50);
    if (type != ElementType::quad4) CHECK(unseen_by_corners > 5);
  }
}

TEST_CASE("mid-side nodes in another order are found, all over as at the corner they name") {
  OneElement element(ElementType::tet10);
  CHECK_FALSE(is_folded(element));
  // Swap the mid-side nodes of edges 12 and 20, and of 30 and 32, as another program numbers them.
  std::swap(element.connectivity[5], element.connectivity[6]);
  CHECK(is_folded(element));
  std::swap(element.connectivity[7], element.connectivity[8]);
  const auto found = find_negative_jacobian(element.view(), 0);
  REQUIRE(found);
  CHECK(found->det < 0.0);
}

TEST_CASE("elements whose Jacobian falls to zero at a corner or an edge are valid") {
  // Quarter-point nodes around corner 0, as at a crack tip, also with the rounding error of six digits.
  for (const double off : {0.0, 1e-7, -1e-7}) {
    OneElement tip(ElementType::tet10);
    for (const CellEdge& edge : cell(tip.type).edges)
      if (edge.a == 0 || edge.b == 0)
        for (std::size_t c = 0; c < 3; ++c) tip.coordinates[3 * edge.middle + c] *= 0.5 * (1.0 + off);
    CHECK(tip.det_at({0, 0, 0}) == doctest::Approx(0.0).epsilon(1e-6));
    CHECK_FALSE(is_folded(tip));
    // Moved closer to the corner than a quarter of the edge, the nodes fold the map.
    for (const CellEdge& edge : cell(tip.type).edges)
      if (edge.a == 0 || edge.b == 0)
        for (std::size_t c = 0; c < 3; ++c) tip.coordinates[3 * edge.middle + c] *= 0.9;
    CHECK(is_folded(tip));
  }
  // A hexahedron degenerated to a wedge: two edges of its upper face coincide.
  OneElement wedge(ElementType::hex8);
  for (std::size_t c = 0; c < 3; ++c) {
    wedge.coordinates[3 * 7 + c] = wedge.coordinates[3 * 4 + c];
    wedge.coordinates[3 * 6 + c] = wedge.coordinates[3 * 5 + c];
  }
  CHECK(std::abs(wedge.det_at({-1, -1, 1})) < 1e-12);
  CHECK_FALSE(is_folded(wedge));
}
