// SPDX-License-Identifier: BSD-3-Clause
// The loops over elements in a row: the same for every instruction set.
#include "simd/row_points.hpp"

#include <doctest/doctest.h>

#include <random>
#include <stdexcept>
#include <string_view>
#include <vector>

using namespace kacanov::simd;

namespace {

/// Numbers without a pattern: of sines every Jacobian would be singular.
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
    loops.strain(slopes.data(), x, u, point);
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
      continue;  // this processor or build has none
    }
    compare_with_plain<4>(set);
    compare_with_plain<8>(set);
    compare_with_plain<10>(set);
  }
}
