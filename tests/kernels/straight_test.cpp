// SPDX-License-Identifier: BSD-3-Clause
// Closed-form integrals over affine elements, compared with sums over their quadrature points.
#include <doctest/doctest.h>

#include "bodies.hpp"
#include "cells/parallelepiped.hpp"
#include "cells/straight.hpp"
#include "operator/nodal_pressure.hpp"

using namespace kacanov;
using elements::StraightSides;
using elements::Tet10;
using test::difference;

namespace {

template <class E>
elements::Nodal<E> distorted(unsigned seed) {
  const std::vector<double> move = test::random_vector(12, seed);
  const auto node = E::node();
  elements::Nodal<E> x;
  for (std::size_t a = 0; a < E::nodes; ++a)
    for (std::size_t k = 0; k < 3; ++k) {
      const double* xi = node[a].data();
      const auto share = elements::barycentric<3>(xi);
      x[3 * a + k] = 2.0 * xi[k];
      for (std::size_t c = 0; c < 4; ++c) x[3 * a + k] += 0.3 * share[c] * move[3 * c + k];
    }
  return x;
}

template <class E>
void check_integrals(unsigned seed) {
  const elements::Nodal<E> x = distorted<E>(seed);
  REQUIRE(elements::has_straight_sides(x));
  std::array<std::array<std::array<double, 3>, 4>, E::nodes> fast, plain{};
  StraightSides(x.data()).integrate(fast);
  double volume = 0.0;
  for (std::size_t q = 0; q < E::points; ++q) {
    const elements::Point<E> point(x, q);
    volume += point.volume;
    const auto share = elements::barycentric<3>(E::point[q].data());
    for (std::size_t a = 0; a < E::nodes; ++a)
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t k = 0; k < 3; ++k) plain[a][c][k] += point.volume * share[c] * point.gradient[a][k];
  }
  CHECK(StraightSides(x.data()).volume == doctest::Approx(volume).epsilon(1e-13));
  for (std::size_t a = 0; a < E::nodes; ++a)
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(fast[a][c][k] - plain[a][c][k]) < 1e-14);
}

}  // namespace

TEST_CASE("integrals over tetrahedra with straight sides are the sums over their points") {
  for (unsigned seed = 1; seed < 20; ++seed)
    check_integrals<elements::Tet4>(seed), check_integrals<Tet10>(seed);
}

TEST_CASE("a node off the middle of its edge bends a side") {
  elements::Nodal<Tet10> x = distorted<Tet10>(3);
  x[3 * 7] += 1e-9;
  CHECK_FALSE(elements::has_straight_sides(x));
}

TEST_CASE("diagonal blocks of linear tetrahedra are those of their point") {
  for (unsigned seed = 1; seed < 20; ++seed) {
    const elements::Nodal<elements::Tet4> x = distorted<elements::Tet4>(seed);
    double fast[4][9] = {}, plain[4][9] = {};
    StraightSides(x.data()).add_diagonal_blocks(3.0, std::array{0.7}, fast);
    for (int a = 0; a < 4; ++a)
      elements::Point<elements::Tet4>(x, 0).add_diagonal_block(a, 3.0, 0.7, plain[a]);
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t k = 0; k < 9; ++k) CHECK(std::abs(fast[a][k] - plain[a][k]) < 1e-12);
  }
}

TEST_CASE("diagonal blocks of tetrahedra with straight sides are the sums over their points") {
  for (unsigned seed = 1; seed < 20; ++seed)
    for (const double bulk : {0.0, 3.0}) {
      const elements::Nodal<Tet10> x = distorted<Tet10>(seed);
      const std::vector<double> g = test::random_vector(4, seed + 100);
      double fast[10][9] = {}, plain[10][9] = {};
      StraightSides(x.data()).add_diagonal_blocks(bulk, {g[0], g[1], g[2], g[3]}, fast);
      for (std::size_t q = 0; q < 4; ++q)
        for (int a = 0; a < 10; ++a) elements::Point<Tet10>(x, q).add_diagonal_block(a, bulk, g[q], plain[a]);
      for (std::size_t a = 0; a < 10; ++a)
        for (std::size_t k = 0; k < 9; ++k) CHECK(std::abs(fast[a][k] - plain[a][k]) < 1e-12);
    }
}

TEST_CASE("diagonal blocks of parallelepipeds are the sums over their points") {
  for (unsigned seed = 1; seed < 20; ++seed)
    for (const bool mean : {false, true}) {
      const std::vector<double> bend = test::random_vector(9, seed), g = test::random_vector(8, seed + 100);
      elements::Nodal<elements::Hex8> x;
      for (std::size_t a = 0; a < 8; ++a)
        for (std::size_t i = 0; i < 3; ++i) {
          x[3 * a + i] = 2.0 * elements::Hex8::corner[a][i];
          for (std::size_t k = 0; k < 3; ++k)
            x[3 * a + i] += 0.3 * bend[3 * i + k] * elements::Hex8::corner[a][k];
        }
      std::array<double, 8> of_points;
      std::copy(g.begin(), g.end(), of_points.begin());
      double fast[8][9] = {}, plain[8][9] = {};
      elements::Parallelepiped(x.data()).add_diagonal_blocks(3.0, mean, of_points, fast);
      const auto points = elements::points_of<elements::Hex8>(x, mean);
      for (std::size_t q = 0; q < 8; ++q)
        for (int a = 0; a < 8; ++a) points[q].add_diagonal_block(a, 3.0, g[q], plain[a]);
      for (std::size_t a = 0; a < 8; ++a)
        for (std::size_t k = 0; k < 9; ++k) CHECK(std::abs(fast[a][k] - plain[a][k]) < 1e-12);
    }
}

TEST_CASE("volumes round corners are the reference's, sides straight or bent") {
  for (const ElementType type : {ElementType::tet4, ElementType::tet10})
    for (const bool bent : {false, true}) {
      auto mesh = meshes::box(type, {3, 2, 2}, {1.5, 1.0, 1.0});
      meshes::jitter(mesh, 0.04, 5);
      meshes::straighten(mesh);
      if (bent) mesh.coordinates[3 * (mesh.coordinates.size() / 6)] += 0.01;
      const auto owned = test::with_every_law(std::move(mesh), 5);
      const Body body = owned.body();
      const CornerMeans means = corner_means(body);
      REQUIRE(means.size() > 0);
      std::vector<double> change(means.size()), volume(means.size());
      reference::corner_changes(body, means, std::vector<double>(body.unknowns(), 0.0), change, volume);
      CHECK(difference(corner_volumes(body, means), volume) < 1e-13);
    }
}
