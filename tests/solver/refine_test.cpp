// SPDX-License-Identifier: BSD-3-Clause
// Refinement, uniform and by bisection: conforming meshes, bounded element quality, preserved groups and
// curves.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include <kacanov/discretisation.hpp>
#include <kacanov/error.hpp>
#include <kacanov/refine.hpp>
#include "problem/vector3.hpp"
#include "problem_models.hpp"

using namespace kacanov;

namespace kacanov::testing {

/// Returns the total length or area of a group of straight facets.
inline double measure(const Mesh& mesh, const Group& group) {
  double sum = 0.0;
  for (const std::int32_t f : group.members) {
    const auto n = mesh.facet(f);
    const Vector3 a = position(mesh, n[0]), b = position(mesh, n[1]);
    if (mesh.dim() == 2) {
      sum += norm(b - a);
      continue;
    }
    const Vector3 c = position(mesh, n[2]);
    sum += norm(cross(b - a, c - a)) * (cell(mesh.type).facet().corners == 4 ? 1.0 : 0.5);
  }
  return sum;
}

}  // namespace kacanov::testing

namespace {

BoxSpec box_of(ElementType type, std::array<int, 3> cells) {
  BoxSpec spec;
  spec.type = type;
  spec.size = {2.0, 1.0, 1.5};
  spec.cells = cells;
  return spec;
}

/// Returns coordinates as integers on a fine grid, so that equal points compare equal.
std::set<std::array<long, 3>> points(const Mesh& mesh) {
  std::set<std::array<long, 3>> all;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const Vector3 x = position(mesh, static_cast<std::int32_t>(n));
    all.insert({std::lround(x[0] * 1e6), std::lround(x[1] * 1e6), std::lround(x[2] * 1e6)});
  }
  return all;
}

}  // namespace

TEST_CASE("a refined box has the nodes, the elements and the sides of a box with twice the cells") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const Mesh coarse = make_box(box_of(type, {3, 2, 1}));
    const Mesh twice = make_box(box_of(type, {6, 4, 2}));
    const Mesh fine = refine(coarse);
    CHECK_NOTHROW(check_mesh(fine));
    CHECK(fine.element_count() == twice.element_count());
    CHECK(fine.facet_count() == twice.facet_count());
    CHECK(fine.node_count() == twice.node_count());
    CHECK(points(fine) == points(twice));
    REQUIRE(fine.groups.size() == coarse.groups.size());
    for (std::size_t g = 0; g < fine.groups.size(); ++g) {
      CAPTURE(fine.groups[g].name);
      const std::size_t children = std::size_t{1} << coarse.groups[g].dimension;
      if (coarse.groups[g].dimension >= coarse.dim() - 1)
        CHECK(fine.groups[g].members.size() == coarse.groups[g].members.size() * children);
      if (coarse.groups[g].dimension == coarse.dim() - 1)
        CHECK(testing::measure(fine, fine.groups[g]) ==
              doctest::Approx(testing::measure(coarse, coarse.groups[g])).epsilon(1e-12));
    }
  }
}

TEST_CASE("edges keep their curves: new nodes lie where the element's own map takes them") {
  Mesh mesh = make_box(box_of(ElementType::tet10, {2, 2, 2}));
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    double* x = &mesh.coordinates[3 * n];
    x[2] += 0.1 * x[0] * x[0];  // a parabola, which quadratic edges represent exactly
  }
  const Mesh fine = refine(refine(mesh));
  CHECK_NOTHROW(check_mesh(fine));
  double low = 1.0;
  for (const Group& group : fine.groups) {
    if (group.name != "bottom") continue;
    for (const std::int32_t f : group.members)
      for (const std::int32_t n : fine.facet(f)) {
        const Vector3 x = position(fine, n);
        CHECK(x[2] == doctest::Approx(0.1 * x[0] * x[0]).epsilon(1e-12));
        low = std::min(low, x[0]);
      }
  }
  CHECK(low == 0.0);
}

TEST_CASE("repeated refinement keeps tetrahedra in shape") {
  Mesh mesh = make_box(box_of(ElementType::tet4, {1, 1, 1}));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  for (double& x : mesh.coordinates) x += shift(random);
  const auto worst_shape = [](const Mesh& m) {
    double worst = 1e300;
    for (std::size_t e = 0; e < m.element_count(); ++e) {
      const std::int32_t* n = &m.elements[4 * e];
      const Vector3 o = position(m, n[0]), a = position(m, n[1]) - o, b = position(m, n[2]) - o,
                    c = position(m, n[3]) - o;
      const double edge = std::max({norm(a), norm(b), norm(c), norm(a - b), norm(b - c), norm(c - a)});
      worst = std::min(worst, dot(cross(a, b), c) / (edge * edge * edge));
    }
    return worst;
  };
  const double first = worst_shape(refine(mesh));
  CHECK(first > 0.0);
  CHECK(worst_shape(refine(refine(refine(mesh)))) > 0.5 * first);
}

TEST_CASE("named points and lines, tags and materials are taken over") {
  Mesh mesh = make_box(box_of(ElementType::tri3, {2, 1, 0}));
  mesh.node_tags = {10, 20, 30, 40, 50, 60};
  mesh.groups.push_back({"half", 2, {0, 1}});
  mesh.groups.push_back({"corner", 0, {0}});
  const Mesh fine = refine(mesh);
  CHECK(std::equal(mesh.node_tags.begin(), mesh.node_tags.end(), fine.node_tags.begin()));
  CHECK(fine.node_tags.size() == fine.node_count());
  CHECK(std::set<std::int64_t>(fine.node_tags.begin(), fine.node_tags.end()).size() == fine.node_count());
  CHECK(fine.element_tags.empty());
  CHECK(fine.groups[fine.groups.size() - 2].members == std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(fine.groups.back().members == std::vector<std::int32_t>{0});

  Mesh solid = make_box(box_of(ElementType::hex8, {1, 1, 1}));
  solid.groups.push_back({"edge", 1, {0, 1}});
  const Group edge = refine(solid).groups.back();
  CHECK(edge.members.size() == 3);  // its ends and the new node between them
}

TEST_CASE("a raised box has the nodes, the elements and the sides of a quadratic one") {
  Mesh linear = make_box(box_of(ElementType::tet4, {3, 2, 1}));
  for (std::size_t e = 0; e < linear.element_count(); ++e)
    linear.element_tags.push_back(7 + 2 * static_cast<std::int64_t>(e));
  for (std::size_t n = 0; n < linear.node_count(); ++n)
    linear.node_tags.push_back(1000 - static_cast<std::int64_t>(n));
  linear.groups.push_back({"edge", 1, {0, 1, 2, 3}});  // the first nodes along x
  const Mesh quadratic = raise_order(linear), box = make_box(box_of(ElementType::tet10, {3, 2, 1}));
  CHECK_NOTHROW(check_mesh(quadratic));
  CHECK(quadratic.type == ElementType::tet10);
  CHECK(quadratic.element_count() == box.element_count());
  CHECK(quadratic.facet_count() == box.facet_count());
  CHECK(points(quadratic) == points(box));
  CHECK(quadratic.element_tags == linear.element_tags);
  CHECK(std::equal(linear.node_tags.begin(), linear.node_tags.end(), quadratic.node_tags.begin()));
  CHECK(quadratic.node_tags.size() == quadratic.node_count());
  CHECK(quadratic.node_tags.back() ==
        1000 + static_cast<std::int64_t>(quadratic.node_count() - linear.node_count()));
  for (std::size_t g = 0; g + 1 < linear.groups.size(); ++g) {
    CAPTURE(linear.groups[g].name);
    CHECK(quadratic.groups[g].members.size() == linear.groups[g].members.size());
    if (linear.groups[g].dimension == 2)
      CHECK(testing::measure(quadratic, quadratic.groups[g]) ==
            doctest::Approx(testing::measure(linear, linear.groups[g])));
  }
  const Group& edge = quadratic.groups.back();
  CHECK(edge.members.size() == 7);
  for (const std::int32_t n : edge.members) {
    const Vector3 x = position(quadratic, n);
    CHECK(std::abs(x[1]) + std::abs(x[2]) == 0.0);
  }
}

TEST_CASE("only linear tetrahedra are raised") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    if (type == ElementType::tet4)
      CHECK(raised(type) == ElementType::tet10);
    else
      CHECK_THROWS_AS(raise_order(make_box(box_of(type, {1, 1, 1}))), InputError);
  }
}

namespace {

std::vector<ElementType> simplices() {
  std::vector<ElementType> types;
  for (const ElementType type : element_types())
    if (can_bisect(type)) types.push_back(type);
  return types;
}

Mesh split_block(ElementType type, int cells = 2) {
  return make_box({{2.0, 1.0, 1.5}, {2 * cells, cells, cells}, type});
}

/// Returns twice the area, or six times the volume, of the straight element.
double size_of(const Mesh& mesh, std::size_t e) {
  const std::size_t n = nodes_per_element(mesh.type);
  const auto corner = [&](std::size_t a) { return position(mesh, mesh.elements[e * n + a]); };
  const Vector3 a = corner(1) - corner(0), b = corner(2) - corner(0);
  if (mesh.dim() == 2) return a[0] * b[1] - a[1] * b[0];
  return dot(cross(a, b), corner(3) - corner(0));
}

/// Returns size_of divided by the longest edge to the power of the dimension: 0 for a degenerate element.
double quality(const Mesh& mesh, std::size_t e) {
  const std::size_t n = nodes_per_element(mesh.type);
  const int corners = cell(mesh.type).corners;
  double longest = 0.0;
  for (int a = 0; a < corners; ++a)
    for (int b = 0; b < a; ++b)
      longest = std::max(longest, norm(position(mesh, mesh.elements[e * n + static_cast<std::size_t>(a)]) -
                                       position(mesh, mesh.elements[e * n + static_cast<std::size_t>(b)])));
  return size_of(mesh, e) / std::pow(longest, mesh.dim());
}

double worst_quality(const Mesh& mesh) {
  double worst = 1.0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) worst = std::min(worst, quality(mesh, e));
  return worst;
}

double total_size(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) sum += size_of(mesh, e);
  return sum;
}

std::vector<std::int32_t> some(const Mesh& mesh, double share, std::mt19937& random) {
  std::vector<std::int32_t> marked;
  std::bernoulli_distribution chosen(share);
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    if (chosen(random)) marked.push_back(static_cast<std::int32_t>(e));
  return marked;
}

}  // namespace

TEST_CASE("a marked triangle, by hand") {
  // Two triangles that share their longest edge, the diagonal 0–3, so that the neighbour is bisected there
  // too.
  const Mesh mesh = make_box({{1.0, 1.0, 0.0}, {1, 1, 0}, ElementType::tri3});
  REQUIRE(mesh.element_count() == 2);
  const std::vector<std::int32_t> first{0};
  const Mesh fine = bisect(mesh, first);
  CHECK_NOTHROW(check_mesh(fine));
  CHECK(fine.element_count() == 6);  // four from the marked one, two from its neighbour
  CHECK(fine.node_count() == 7);
  CHECK(total_size(fine) == doctest::Approx(2.0));
}

TEST_CASE("nothing marked: nothing changes") {
  for (const ElementType type : simplices()) {
    const Mesh mesh = split_block(type);
    const Mesh same = bisect(mesh, {});
    CHECK(same.elements == mesh.elements);
    CHECK(same.coordinates == mesh.coordinates);
    for (std::size_t g = 0; g < mesh.groups.size(); ++g)
      CHECK(same.groups[g].members == mesh.groups[g].members);
  }
}

TEST_CASE("whatever is marked, elements fit together, sides stay, shapes stay good") {
  std::mt19937 random(7);
  for (const ElementType type : simplices()) {
    CAPTURE(cell(type).name);
    const Mesh start = split_block(type, 1);
    const double before = worst_quality(start);
    Mesh mesh = start;
    for (int round = 0; round < 5; ++round) {
      const std::vector<std::int32_t> marked = some(mesh, round < 2 ? 0.2 : 0.01, random);
      const Mesh finer = bisect(mesh, marked);
      CHECK_NOTHROW(check_mesh(finer));
      CHECK(finer.element_count() >= mesh.element_count() + 7 * marked.size() / 2);
      CHECK(total_size(finer) == doctest::Approx(total_size(start)).epsilon(1e-12));
      for (std::size_t g = 0; g < start.groups.size(); ++g) {
        CAPTURE(start.groups[g].name);
        CHECK(finer.groups[g].name == start.groups[g].name);
        if (start.groups[g].dimension == start.dim() - 1)
          CHECK(testing::measure(finer, finer.groups[g]) ==
                doctest::Approx(testing::measure(start, start.groups[g])).epsilon(1e-12));
      }
      mesh = finer;
    }
    CHECK(worst_quality(mesh) > 0.2 * before);
  }
}

TEST_CASE("a corner asked for again and again: its elements shrink, few others do") {
  for (const ElementType type : simplices()) {
    CAPTURE(cell(type).name);
    Mesh mesh = split_block(type, 1);
    const double before = worst_quality(mesh);
    for (int round = 0; round < 8; ++round) {
      std::vector<std::int32_t> marked;
      const auto n = static_cast<std::size_t>(nodes_per_element(type));
      for (std::size_t k = 0; k < mesh.elements.size(); ++k)
        if (mesh.elements[k] == 0) marked.push_back(static_cast<std::int32_t>(k / n));
      mesh = bisect(mesh, marked);
    }
    CHECK_NOTHROW(check_mesh(mesh));
    CHECK(worst_quality(mesh) > 0.2 * before);
    CHECK(mesh.element_count() < (mesh.dim() == 2 ? 1000 : 10000));
    double smallest = 1.0;
    for (std::size_t e = 0; e < mesh.element_count(); ++e) smallest = std::min(smallest, size_of(mesh, e));
    CHECK(smallest < std::pow(0.5, 7 * mesh.dim()));
  }
}

TEST_CASE("curves stay: new nodes lie where the element's own map takes them") {
  Mesh mesh = split_block(ElementType::tet10);
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    double* x = &mesh.coordinates[3 * n];
    x[2] += 0.1 * x[0] * x[0];  // a parabola, which quadratic edges represent exactly
  }
  std::mt19937 random(3);
  const Mesh fine = bisect(bisect(mesh, some(mesh, 0.2, random)), std::vector<std::int32_t>{0, 5, 11});
  CHECK_NOTHROW(check_mesh(fine));
  for (const Group& group : fine.groups) {
    if (group.name != "bottom" && group.name != "top") continue;
    for (const std::int32_t f : group.members)
      for (const std::int32_t node : fine.facet(static_cast<std::size_t>(f))) {
        const Vector3 x = position(fine, node);
        CHECK(x[2] == doctest::Approx((group.name == "top" ? 1.5 : 0.0) + 0.1 * x[0] * x[0]).epsilon(1e-12));
      }
  }
}

TEST_CASE("elements, lines of nodes and numbers of a file are taken over") {
  for (const ElementType type : {ElementType::tet4, ElementType::tet10}) {
    Mesh mesh = split_block(type, 1);
    mesh.groups.push_back({"half", 3, {}});
    double volume = 0.0;
    for (std::size_t e = 0; e < mesh.element_count(); e += 2) {
      mesh.groups.back().members.push_back(static_cast<std::int32_t>(e));
      volume += size_of(mesh, e);
    }
    mesh.groups.push_back({"edge", 1, {}});
    mesh.groups.push_back({"point", 0, {0}});
    for (std::size_t i = 0; i < mesh.node_count(); ++i) {
      const Vector3 x = position(mesh, static_cast<std::int32_t>(i));
      if (x[1] == 0.0 && x[2] == 0.0)
        mesh.groups[mesh.groups.size() - 2].members.push_back(static_cast<std::int32_t>(i));
      mesh.node_tags.push_back(100 + static_cast<std::int64_t>(i));
    }
    const auto all = [](const Mesh& of) {
      std::vector<std::int32_t> elements(of.element_count());
      std::iota(elements.begin(), elements.end(), 0);
      return elements;
    };
    const Mesh half = bisect(mesh, all(mesh));
    CHECK(half.element_count() >= 8 * mesh.element_count());
    const Mesh fine = bisect(half, all(half));
    double now = 0.0;
    const std::size_t groups = fine.groups.size();
    for (const std::int32_t e : fine.groups[groups - 3].members)
      now += size_of(fine, static_cast<std::size_t>(e));
    CHECK(now == doctest::Approx(volume));
    const std::size_t old = mesh.groups[groups - 2].members.size();
    CHECK(fine.groups[groups - 2].members.size() > old);
    double end = 0.0;
    for (const std::int32_t node : fine.groups[groups - 2].members) {
      CHECK(position(fine, node)[1] == 0.0);
      CHECK(position(fine, node)[2] == 0.0);
      end = std::max(end, position(fine, node)[0]);
    }
    CHECK(end == 2.0);
    std::size_t there = 0;
    for (std::size_t i = 0; i < fine.node_count(); ++i) {
      const Vector3 x = position(fine, static_cast<std::int32_t>(i));
      there += x[1] == 0.0 && x[2] == 0.0 ? 1 : 0;
    }
    CHECK(fine.groups[groups - 2].members.size() == there);
    CHECK(fine.groups.back().members == std::vector<std::int32_t>{0});
    CHECK(fine.node_tags[0] == 100);
    CHECK(fine.node_tags.back() == 99 + static_cast<std::int64_t>(fine.node_count()));
  }
}

TEST_CASE("the worst elements have the share asked for, and no fewer do") {
  const std::vector<double> energy{1.0, 4.0, 2.0, 3.0};
  CHECK(worst_elements(energy, 0.4) == std::vector<std::int32_t>{1});
  CHECK(worst_elements(energy, 0.5) == std::vector<std::int32_t>{1, 3});
  CHECK(worst_elements(energy, 1.0).size() == 4);
  CHECK(worst_elements(std::vector<double>(3, 0.0), 0.5).empty());
}

TEST_CASE("other elements are refused") {
  CHECK_THROWS_WITH_AS(bisect(split_block(ElementType::hex8), {}),
                       doctest::Contains("expected tri3, tet4 or tet10"), InputError);
}

TEST_CASE("elements that go through an obstacle between their nodes are found, and no others") {
  for (const ElementType type : simplices()) {
    const Mesh mesh = split_block(type);
    const std::size_t dim = mesh.dim(), up = dim - 1;
    const double height = dim == 2 ? 1.0 : 1.5;
    // A small ball over one point of the top, a tenth as wide as a facet.
    Vector3 centre{0.3, dim == 2 ? 0.0 : 0.1, 0.0};
    centre[up] = height + 0.04;
    Model model = testing::elastic_model();
    model.boundary.push_back(testing::displacement(testing::named("bottom"),
                                                   {0.0, 0.0, dim == 3 ? std::optional(0.0) : std::nullopt}));
    ContactEntry entry;
    entry.on = testing::named("top");
    entry.obstacle = Sphere{centre, 0.05, std::nullopt};
    model.contact.push_back(entry);
    const Problem problem = build_problem(mesh, model);
    std::vector<double> u(problem.mesh.coordinates.size(), 0.0);
    const std::vector<std::int32_t> entered = penetrated_elements(problem, model, u, 0.0);
    REQUIRE(entered.size() == 1);
    const std::size_t nodes = nodes_per_element(type);
    double lower = HUGE_VAL, upper = -HUGE_VAL, highest = -HUGE_VAL;
    for (std::size_t a = 0; a < nodes; ++a) {
      const Vector3 x = position(mesh, mesh.elements[static_cast<std::size_t>(entered[0]) * nodes + a]);
      lower = std::min(lower, x[0]);
      upper = std::max(upper, x[0]);
      highest = std::max(highest, x[up]);
    }
    CHECK(lower <= 0.3);
    CHECK(upper >= 0.3);
    CHECK(highest == doctest::Approx(height));
    // The ball penetrates by 0.01; with this tolerance, or with the body lower by more, no element is
    // reported.
    CHECK(penetrated_elements(problem, model, u, 0.0101).empty());
    for (std::size_t i = up; i < u.size(); i += dim) u[i] = -0.0101;
    CHECK(penetrated_elements(problem, model, u, 0.0).empty());
    model.contact[0].relinearise = true;
    std::fill(u.begin(), u.end(), 0.0);
    CHECK(penetrated_elements(problem, model, u, 0.0).empty());
  }
}
