// SPDX-License-Identifier: BSD-3-Clause
// Uniform refinement: a refined box is the box with half the cell size; curves and groups are preserved.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include <kacanov/error.hpp>
#include <kacanov/refine.hpp>
#include "facet_measure.hpp"
#include "problem/vector3.hpp"

using namespace kacanov;

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
