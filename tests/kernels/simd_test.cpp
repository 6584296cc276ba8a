// SPDX-License-Identifier: BSD-3-Clause
// Vectorised loops: every instruction set gives the same results; closed-form integrals over affine elements.
#include <doctest/doctest.h>

#include <random>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "bodies.hpp"
#include "cells/parallelepiped.hpp"
#include "cells/straight.hpp"
#include "operator/nodal_pressure.hpp"
#include "simd/row_points.hpp"

using namespace kacanov::simd;
using namespace kacanov;

namespace {

/// Random numbers; regular values such as sines would make every Jacobian singular.
struct Numbers {
  std::minstd_rand draw;
  double operator()() { return std::uniform_real_distribution<double>(-1.0, 1.0)(draw); }
  void fill(RowLanes& lanes) {
    for (double& lane : lanes) lane = (*this)();
  }
};

void check_near(const RowLanes& found, const RowLanes& expected) {
  for (std::size_t lane = 0; lane < row_lanes; ++lane)
    CHECK(found[lane] == doctest::Approx(expected[lane]).epsilon(1e-10));
}

void check_near(const RowStrain& found, const RowStrain& expected) {
  for (std::size_t c = 0; c < 6; ++c) check_near(found.dev[c], expected.dev[c]);
  check_near(found.trace, expected.trace);
  check_near(found.norm, expected.norm);
}

template <std::size_t nodes>
struct Worked {
  using Loops = RowLoops<nodes>;
  RowPoint point;
  RowMap map;
  RowLanes strain{}, rotation{};
  RowLanes position[3];
  RowStrain smooth;
  RowLanes work;

  explicit Worked(const Loops& loops) {
    Numbers number;
    RowLanes x[nodes][3], u[nodes][3];
    std::vector<double> slopes(nodes * 3), shape(nodes), share(Loops::corners);
    for (auto* values : {&slopes, &shape, &share})
      for (double& value : *values) value = number();
    for (auto* values : {&x, &u})
      for (auto& node : *values)
        for (RowLanes& lanes : node) number.fill(lanes);
    typename Loops::Polynomials polynomials;
    for (auto& one : polynomials) {
      for (RowLanes& lanes : one.centre) number.fill(lanes);
      number.fill(one.scale);
      for (auto& term : one.coefficient)
        for (RowLanes& lanes : term) number.fill(lanes);
    }
    RowLanes ga, gb, bulk, weight;
    for (auto* lanes : {&ga, &gb, &bulk, &weight, &work}) number.fill(*lanes);
    typename Loops::Sides of_x, of_u;
    loops.take_sides(x, of_x);
    loops.take_sides(u, of_u);
    loops.strain(slopes.data(), of_x, of_u, point);
    loops.raise(point, strain, rotation);
    loops.map(slopes.data(), of_x, map);
    loops.position(shape.data(), x, position);
    loops.smooth(share.data(), polynomials, position, smooth);
    loops.add_work({point.strain, smooth, ga, gb, bulk}, weight, work);
  }
};

template <std::size_t nodes>
void compare_with_plain(std::string_view set) {
  CAPTURE(nodes);
  const Worked<nodes> found(row_loops<nodes>(set)), expected(row_loops<nodes>("plain"));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) check_near(found.point.h[i][k], expected.point.h[i][k]);
  check_near(found.point.det, expected.point.det);
  check_near(found.point.strain, expected.point.strain);
  check_near(found.strain, expected.strain);
  check_near(found.rotation, expected.rotation);
  check_near(found.map.det, expected.map.det);
  check_near(found.map.thinness, expected.map.thinness);
  for (std::size_t i = 0; i < 3; ++i) check_near(found.position[i], expected.position[i]);
  check_near(found.smooth, expected.smooth);
  check_near(found.work, expected.work);
}

}  // namespace

TEST_CASE("loops over elements in a row do the same on every instruction set") {
  for (const std::string_view set : {"avx2", "avx512"}) {
    CAPTURE(set);
    try {
      (void)row_loops<4>(set);
    } catch (const std::invalid_argument&) {
      continue;  // not supported by this processor or build
    }
    compare_with_plain<4>(set);
    compare_with_plain<8>(set);
    compare_with_plain<10>(set);
  }
}

TEST_CASE("principal strains of simple states are known") {
  const double e = 1e-3, shear = 2e-3;
  struct State {
    double h[3][3];
    double strain, rotation;
  };
  const State states[] = {
      {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 0.0, 0.0},
      {{{e, 0, 0}, {0, e, 0}, {0, 0, e}}, e, 0.0},
      {{{e, 0, 0}, {0, 0, 0}, {0, 0, 0}}, e, 0.0},
      {{{0, 0, 0}, {0, 0, 0}, {0, 0, -e}}, e, 0.0},
      {{{-e, 0, 0}, {0, -e, 0}, {0, 0, 0}}, e, 0.0},
      {{{0, shear, 0}, {0, 0, 0}, {0, 0, 0}}, 0.5 * shear, 0.5 * shear},
      {{{0, 0, 0}, {0, 0, shear}, {0, -shear, 0}}, 0.0, shear},
      {{{3 * e, 0, 0}, {0, -2 * e, 0}, {0, 0, e}}, 3 * e, 0.0},
  };
  const RowLoops<4>& loops = row_loops<4>({});
  const double slopes[12] = {-1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  RowLanes x[4][3] = {}, u[4][3] = {}, strain{}, rotation{};
  for (std::size_t i = 0; i < 3; ++i) x[i + 1][i].fill(1.0);
  for (std::size_t lane = 0; lane < row_lanes; ++lane)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) u[k + 1][i][lane] = states[lane % 8].h[i][k];
  RowPoint point;
  loops.strain(slopes, x, u, point);
  loops.raise(point, strain, rotation);
  for (std::size_t lane = 0; lane < row_lanes; ++lane) {
    CAPTURE(lane);
    // Where two principal strains coincide, rounding errors of the invariants leave half of the digits.
    CHECK(strain[lane] == doctest::Approx(states[lane % 8].strain).epsilon(1e-7));
    CHECK(rotation[lane] == doctest::Approx(states[lane % 8].rotation).epsilon(1e-12));
  }
  const RowLanes before = strain;
  for (auto& gradient : point.h)
    for (RowLanes& lanes : gradient) lanes.fill(0.0);
  for (RowLanes& lanes : point.strain.dev) lanes.fill(0.0);
  point.strain.norm.fill(0.0);
  loops.raise(point, strain, rotation);
  check_near(strain, before);
}

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
