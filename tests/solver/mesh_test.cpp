// SPDX-License-Identifier: BSD-3-Clause
// Boundary, checks and generated boxes: closed surfaces, volumes by the divergence theorem, errors that name
// the elements; nodal fields given as numbers.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include <kacanov/error.hpp>
#include <kacanov/mesh.hpp>
#include <kacanov/part.hpp>
#include <kacanov/refine.hpp>
#include <kacanov/vector3.hpp>
#include "problem/vector3.hpp"

using namespace kacanov;

namespace {

const auto all_types = element_types();

Vector3 at(const Mesh& mesh, std::int32_t node) {
  Vector3 x{};
  for (int k = 0; k < mesh.dim(); ++k)
    x[k] = mesh.coordinates[static_cast<std::size_t>(node) * static_cast<std::size_t>(mesh.dim()) +
                            static_cast<std::size_t>(k)];
  return x;
}

/// Returns area times outward normal of a flat facet, from its corners.
Vector3 area_vector(const Mesh& mesh, std::size_t facet) {
  const auto n = mesh.facet(facet);
  if (mesh.dim() == 2) {
    const Vector3 a = at(mesh, n[0]), b = at(mesh, n[1]);
    return {b[1] - a[1], a[0] - b[0], 0};
  }
  const std::size_t corners = cell(mesh.type).facet().corners;
  Vector3 sum{};
  const Vector3 o = at(mesh, n[0]);
  for (std::size_t k = 1; k + 1 < corners; ++k) {
    Vector3 a = at(mesh, n[k]), b = at(mesh, n[k + 1]);
    for (std::size_t c = 0; c < 3; ++c) {
      a[c] -= o[c];
      b[c] -= o[c];
    }
    sum[0] += (a[1] * b[2] - a[2] * b[1]) / 2;
    sum[1] += (a[2] * b[0] - a[0] * b[2]) / 2;
    sum[2] += (a[0] * b[1] - a[1] * b[0]) / 2;
  }
  return sum;
}

double length_of(const Vector3& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// Returns the message of check_mesh, empty if it accepts the mesh.
std::string complaint(const Mesh& mesh) {
  try {
    check_mesh(mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// A mesh from its parts, with node numbers that differ from the indices.
Mesh mesh_of(ElementType type, std::vector<double> coordinates, std::vector<std::int32_t> elements) {
  Mesh mesh;
  mesh.type = type;
  mesh.coordinates = std::move(coordinates);
  mesh.elements = std::move(elements);
  for (std::size_t i = 0; i < mesh.node_count(); ++i)
    mesh.node_tags.push_back(100 + static_cast<std::int64_t>(i));
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    mesh.element_tags.push_back(70 + static_cast<std::int64_t>(e));
  find_boundary(mesh);
  return mesh;
}

/// Five points: tetrahedra 0123 and 0214 on the two sides of the triangle 012.
const std::vector<double> two_tetrahedra{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a box is a valid mesh whose closed boundary encloses its volume") {
  for (const ElementType type : all_types) {
    const BoxSpec spec{{4, 0.5, 2}, {3, 2, 4}, type};
    const Mesh mesh = make_box(spec);
    CAPTURE(static_cast<int>(type));
    CHECK(complaint(mesh).empty());
    const double volume = mesh.dim() == 2 ? 2.0 : 4.0;
    Vector3 sum{};
    double flux = 0, area = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
      const Vector3 a = area_vector(mesh, f), x = at(mesh, mesh.facet(f)[0]);
      for (std::size_t k = 0; k < 3; ++k) sum[k] += a[k];
      flux += x[0] * a[0] + x[1] * a[1] + x[2] * a[2];
      area += length_of(a);
    }
    CHECK(length_of(sum) == doctest::Approx(0).epsilon(1e-12));
    CHECK(flux / mesh.dim() == doctest::Approx(volume));
    CHECK(area == doctest::Approx(mesh.dim() == 2 ? 9.0 : 2 * (4 * 0.5 + 4 * 2 + 0.5 * 2)));
  }
}

TEST_CASE("the sides of a box are named, complete and turned outwards") {
  for (const ElementType type : all_types) {
    const Mesh mesh = make_box({{4, 0.5, 2}, {2, 3, 1}, type});
    CAPTURE(static_cast<int>(type));
    const bool flat = mesh.dim() == 2;
    const std::vector<std::string> names =
        flat ? std::vector<std::string>{"left", "right", "bottom", "top"}
             : std::vector<std::string>{"left", "right", "front", "back", "bottom", "top"};
    const Vector3 full = flat ? Vector3{0.5, 4, 0} : Vector3{1, 8, 2};
    REQUIRE(mesh.groups.size() == names.size());
    std::size_t members = 0;
    for (std::size_t g = 0; g < names.size(); ++g) {
      CHECK(mesh.groups[g].name == names[g]);
      CHECK(mesh.groups[g].dimension == mesh.dim() - 1);
      CHECK(std::is_sorted(mesh.groups[g].members.begin(), mesh.groups[g].members.end()));
      Vector3 sum{};
      for (const std::int32_t f : mesh.groups[g].members) {
        const Vector3 a = area_vector(mesh, f);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += a[k];
      }
      const std::size_t axis = g / 2;
      CHECK(sum[axis] == doctest::Approx(g % 2 == 0 ? -full[axis] : full[axis]));
      CHECK(length_of(sum) == doctest::Approx(full[axis]));
      members += mesh.groups[g].members.size();
    }
    CHECK(members == mesh.facet_count());
  }
}

TEST_CASE("runs of indices hand out what was put in, and know where it stands") {
  std::vector<std::int32_t> all;
  for (std::int32_t i = 0; i < 200; ++i)
    if (i % 7 != 0 && i % 11 < 8) all.push_back(i);
  IndexRuns runs;
  for (const std::int32_t i : all) runs.push_back(i);
  REQUIRE(runs.size() == all.size());
  CHECK(runs.runs.size() < all.size() / 2);
  for (std::size_t k = 0; k < all.size(); ++k) {
    CHECK(runs[k] == all[k]);
    CHECK(runs.position_of(all[k]) == static_cast<std::int32_t>(k));
  }
}

TEST_CASE("the nodes of a box run along x first, and its diagonals from the lowest corner to the highest") {
  const Mesh flat = make_box({{3, 1, 1}, {3, 1, 1}, ElementType::tri3});
  CHECK(flat.node_count() == 8);
  for (int i = 0; i < 4; ++i) CHECK(flat.coordinates[2 * static_cast<std::size_t>(i)] == i);
  CHECK(std::vector(flat.elements.begin(), flat.elements.begin() + 6) ==
        std::vector<std::int32_t>{0, 1, 5, 0, 5, 4});
  const Mesh cube = make_box({{1, 1, 1}, {1, 1, 1}, ElementType::tet4});
  CHECK(cube.element_count() == 6);
  for (std::size_t e = 0; e < 6; ++e) {
    const auto begin = cube.elements.begin() + static_cast<std::ptrdiff_t>(4 * e);
    CHECK(std::find(begin, begin + 4, 0) != begin + 4);
    CHECK(std::find(begin, begin + 4, 7) != begin + 4);
  }
  CHECK(make_box({{1, 1, 1}, {2, 3, 4}, ElementType::hex8}).node_count() == 60);
  CHECK(make_box({{1, 1, 1}, {2, 3, 4}, ElementType::tet10}).node_count() == 5 * 7 * 9);
}

TEST_CASE("midside nodes of elements and facets lie in the middle of their edges") {
  const Mesh mesh = make_box({{1, 2, 3}, {2, 2, 2}, ElementType::tet10});
  const auto check = [&](std::span<const std::int32_t> nodes, std::size_t corners,
                         const std::vector<std::array<std::size_t, 2>>& edges) {
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(at(mesh, nodes[corners + e])[k] ==
              doctest::Approx((at(mesh, nodes[edges[e][0]])[k] + at(mesh, nodes[edges[e][1]])[k]) / 2));
  };
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    check(std::span(mesh.elements).subspan(10 * e, 10), 4, {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}});
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) check(mesh.facet(f), 3, {{0, 1}, {1, 2}, {2, 0}});
}

TEST_CASE("the boundary of a box is what is found of its elements") {
  for (const ElementType type : all_types)
    for (const std::array<int, 3> cells : {std::array{1, 1, 1}, {2, 1, 1}, {1, 3, 2}, {4, 3, 3}}) {
      const Mesh box = make_box({{3, 2, 1}, cells, type});
      Mesh found = box;
      find_boundary(found);
      CAPTURE(static_cast<int>(type));
      CHECK(box.facets == found.facets);
      CHECK(box.facet_element == found.facet_element);
    }
}

TEST_CASE("the boundary does not depend on the order of the elements") {
  for (const ElementType type : all_types) {
    Mesh mesh = make_box({{1, 1, 1}, {3, 3, 3}, type});
    const auto boundary = [](const Mesh& m) {
      std::set<std::vector<std::int32_t>> facets;
      for (std::size_t f = 0; f < m.facet_count(); ++f) {
        std::vector<std::int32_t> nodes(m.facet(f).begin(), m.facet(f).end());
        std::sort(nodes.begin(), nodes.end());
        facets.insert(nodes);
      }
      return facets;
    };
    const auto before = boundary(mesh);
    std::vector<std::size_t> order(mesh.element_count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    const std::size_t n = nodes_per_element(type);
    std::vector<std::int32_t> shuffled;
    for (const std::size_t e : order)
      shuffled.insert(shuffled.end(), mesh.elements.begin() + static_cast<std::ptrdiff_t>(e * n),
                      mesh.elements.begin() + static_cast<std::ptrdiff_t>((e + 1) * n));
    mesh.elements = shuffled;
    find_boundary(mesh);
    CHECK(before == boundary(mesh));
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
      const auto element =
          std::span(mesh.elements).subspan(static_cast<std::size_t>(mesh.facet_element[f]) * n, n);
      for (const std::int32_t node : mesh.facet(f))
        CHECK(std::find(element.begin(), element.end(), node) != element.end());
    }
  }
}

TEST_CASE("an inverted, degenerate or folded element is named by its number") {
  CHECK(complaint(mesh_of(ElementType::tet4, two_tetrahedra, {0, 1, 2, 3, 0, 2, 1, 4})).empty());
  const std::string one = complaint(mesh_of(ElementType::tet4, two_tetrahedra, {0, 1, 2, 3, 0, 1, 2, 4}));
  CHECK(contains(one, "element 71 is inverted"));
  CHECK(!contains(one, "all others"));
  const std::string both = complaint(mesh_of(ElementType::tet4, two_tetrahedra, {0, 2, 1, 3, 0, 1, 2, 4}));
  CHECK(contains(both, "element 70 is inverted"));
  CHECK(contains(both, "so are all others"));
  CHECK(contains(complaint(mesh_of(ElementType::tri3, {0, 0, 1, 0, 1, 1}, {0, 2, 1})),
                 "element 70 is inverted"));

  auto flat = two_tetrahedra;
  flat[14] = -1e-15;
  CHECK(contains(complaint(mesh_of(ElementType::tet4, flat, {0, 1, 2, 3, 0, 2, 1, 4})),
                 "element 71 is degenerate"));
  flat[14] = -1e-10;  // thin, but far above rounding errors
  CHECK(complaint(mesh_of(ElementType::tet4, flat, {0, 1, 2, 3, 0, 2, 1, 4})).empty());

  Mesh folded = make_box({{1, 1, 1}, {1, 1, 1}, ElementType::hex8});
  for (std::size_t k = 0; k < 3; ++k)
    folded.coordinates[3 * 7 + k] = 0.02;  // pushes the highest corner to the lowest
  CHECK(contains(complaint(folded), "element 1 is folded"));

  // Mid-side nodes in another program's order: det J is positive at all four quadrature points.
  const Mesh swapped = mesh_of(ElementType::tet10, {0, 0,  0, 1, 0, 0,  0,  1,  0, 0, 0,  1,  .5, 0, 0,
                                                    0, .5, 0, 0, 0, .5, .5, .5, 0, 0, .5, .5, .5, 0, .5},
                               {0, 1, 2, 3, 4, 5, 6, 7, 9, 8});
  const std::string order = complaint(swapped);
  CHECK(contains(
      order, "element 70 is folded: its Jacobian is not positive everywhere, its determinant falls to -"));
  CHECK(contains(order, " next to node 10"));
  CHECK(contains(order, "are its midside nodes in the right order"));
  // A quadrilateral with a re-entrant corner.
  CHECK(contains(complaint(mesh_of(ElementType::quad4, {0, 0, 1, 0, 0.45, 0.45, 0, 1}, {0, 1, 2, 3})),
                 "next to node 102 "));
}

TEST_CASE("nodes without an element, wrong coordinates and wrong indices are named") {
  auto more = two_tetrahedra;
  more.insert(more.end(), {5, 5, 5, 6, 6, 6});
  const std::string unused = complaint(mesh_of(ElementType::tet4, more, {0, 1, 2, 3, 0, 2, 1, 4}));
  CHECK(contains(unused, "node 105 belongs to no element"));
  CHECK(contains(unused, "2 nodes"));
  Mesh mesh = mesh_of(ElementType::tet4, two_tetrahedra, {0, 1, 2, 3, 0, 2, 1, 4});
  mesh.coordinates[10] = std::numeric_limits<double>::quiet_NaN();
  CHECK(contains(complaint(mesh), "node 103"));
  mesh.coordinates[10] = 1e200;
  CHECK(contains(complaint(mesh), "element 70 is too large"));
  mesh = mesh_of(ElementType::tet4, two_tetrahedra, {0, 1, 2, 3, 0, 2, 1, 4});
  mesh.elements[7] = 5;
  CHECK(contains(complaint(mesh), "element 71 refers to a node that does not exist"));
  CHECK(contains(complaint(Mesh()), "no elements"));
}

TEST_CASE("elements that overlap or do not fit are named") {
  const std::string twice =
      complaint(mesh_of(ElementType::tet4, two_tetrahedra, {0, 1, 2, 3, 0, 2, 1, 4, 0, 1, 2, 3}));
  CHECK(contains(twice, "elements 70"));
  CHECK(contains(twice, "overlaps itself"));
  auto above = two_tetrahedra;
  above[14] = 2;  // moves the fifth point to the side of the fourth
  const std::string same = complaint(mesh_of(ElementType::tet4, above, {0, 1, 2, 3, 0, 1, 2, 4}));
  CHECK(contains(same, "elements 70 and 71 lie on the same side"));

  Mesh quadratic = make_box({{1, 1, 1}, {1, 1, 1}, ElementType::tet10});
  const auto nodes = static_cast<std::int32_t>(quadratic.node_count());
  // The first element gets its own copy of the node on the diagonal of the cube.
  const auto middle = std::find(quadratic.elements.begin(), quadratic.elements.begin() + 10, 13);
  REQUIRE(middle != quadratic.elements.begin() + 10);
  *middle = nodes;
  quadratic.coordinates.insert(quadratic.coordinates.end(), {0.5, 0.5, 0.5});
  CHECK(contains(complaint(quadratic), "share a side but not its midside nodes"));
}

TEST_CASE("impossible boxes are refused before anything is allocated") {
  const auto refused = [](const BoxSpec& spec, const std::string& part) {
    try {
      make_box(spec);
    } catch (const InputError& error) {
      return contains(error.what(), part);
    }
    return false;
  };
  CHECK(refused({{1, 0, 1}, {1, 1, 1}, ElementType::tet4}, "size[1]"));
  CHECK(refused({{-1, 1, 1}, {1, 1, 1}, ElementType::tri3}, "size[0]"));
  CHECK(refused({{1, 1, std::nan("")}, {1, 1, 1}, ElementType::hex8}, "size[2]"));
  CHECK(refused({{1, 1, std::numeric_limits<double>::infinity()}, {1, 1, 1}, ElementType::hex8}, "size[2]"));
  CHECK(refused({{1, 1, 1}, {1, 1, 0}, ElementType::tet4}, "cells[2]"));
  CHECK(refused({{1, 1, 1}, {2000, 2000, 2000}, ElementType::tet4}, "32-bit"));
  CHECK(refused({{1, 1, 1}, {2147483647, 2147483647, 2147483647}, ElementType::tet10}, "32-bit"));
  CHECK(make_box({{1, 1, 0}, {1, 1, 0}, ElementType::tri3}).element_count() == 2);  // third entry ignored
}

TEST_CASE("numbers at nodes are taken over: what is linear stays so") {
  const auto field = [](const Vector3& x) { return 3.0 + x[0] - 2.0 * x[1] + 5.0 * x[2]; };
  const auto is_linear = [&](const Mesh& mesh) {
    REQUIRE(mesh.node_fields.size() == 1);
    REQUIRE(mesh.node_fields[0].values.size() == mesh.node_count());
    double off = 0.0;
    for (std::size_t n = 0; n < mesh.node_count(); ++n)
      off = std::max(
          off, std::abs(mesh.node_fields[0].values[n] - field(position(mesh, static_cast<std::int32_t>(n)))));
    CHECK(off < 1e-13);
  };
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    Mesh mesh = make_box({{2, 1, 1.5}, {2, 2, 2}, type});
    NodeField& values = mesh.node_fields.emplace_back();
    for (std::size_t n = 0; n < mesh.node_count(); ++n)
      values.values.push_back(field(position(mesh, static_cast<std::int32_t>(n))));
    is_linear(refine(refine(mesh)));
    if (can_bisect(type)) is_linear(bisect(bisect(mesh, std::array{0, 3}), std::array{1, 2}));
    if (type == ElementType::tet4) is_linear(raise_order(mesh));
  }
}
