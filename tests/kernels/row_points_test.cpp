// SPDX-License-Identifier: BSD-3-Clause
// The loops over rows of elements: every instruction set gives the same results.
#include "simd/row_points.hpp"

#include <doctest/doctest.h>

#include <random>
#include <stdexcept>
#include <string_view>
#include <vector>

using namespace kacanov::simd;

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
