// SPDX-License-Identifier: BSD-3-Clause
// Input that the fast operator rejects, and the ordering of nodes and elements for locality.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <kacanov/locality.hpp>
#include <kacanov/operator.hpp>
#include "bodies.hpp"

using namespace kacanov;

TEST_CASE("bad input is named") {
  const auto owned = test::small_body(ElementType::tet4, 1);
  Body body = owned.body();
  CHECK_THROWS_WITH_AS(Operator(body, {0, {}}), doctest::Contains("threads"), std::invalid_argument);
  CHECK_THROWS_WITH_AS(Operator(body, {1, "sse9"}), doctest::Contains("sse9"), std::invalid_argument);
  setenv("KACANOV_INSTRUCTION_SET", "neon", 1);
  CHECK_THROWS_WITH_AS(Operator(body, {1, {}}), doctest::Contains("neon"), std::invalid_argument);
  setenv("KACANOV_INSTRUCTION_SET", "plain", 1);
  CHECK(Operator(body).instruction_set() == "plain");
  unsetenv("KACANOV_INSTRUCTION_SET");
  auto wrong = owned;
  wrong.mesh.connectivity[5] = 12345;
  CHECK_THROWS_WITH_AS(Operator{wrong.body()}, doctest::Contains("12345"), std::invalid_argument);
  wrong = owned;
  std::swap(wrong.mesh.connectivity[4], wrong.mesh.connectivity[5]);
  CHECK_THROWS_AS(Operator{wrong.body()}, std::invalid_argument);
  wrong = owned;
  wrong.mesh.coordinates[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(Operator{wrong.body()}, std::invalid_argument);
  wrong = owned;
  wrong.law_of_element[3] = 99;
  CHECK_THROWS_WITH_AS(Operator{wrong.body()}, doctest::Contains("99"), std::invalid_argument);
  wrong = owned;
  wrong.laws[2].mean_dilatation = true;
  wrong.mesh = meshes::box(ElementType::tri3, {3, 2}, {1, 1});
  wrong.law_of_element.clear();
  CHECK_THROWS_WITH_AS(Operator{wrong.body()}, doctest::Contains("hex8 or quad4"), std::invalid_argument);
  wrong = owned;
  wrong.law_of_element.pop_back();
  CHECK_THROWS_AS(Operator{wrong.body()}, std::invalid_argument);
  wrong = owned;
  wrong.laws.clear();
  wrong.law_of_element.clear();
  CHECK_THROWS_WITH_AS(Operator{wrong.body()}, doctest::Contains("at least 1"), std::invalid_argument);
  Operator op(body);
  std::vector<double> x(op.unknowns()), y(op.unknowns() - 1);
  CHECK_THROWS_AS(op.apply(x, y), std::invalid_argument);
  CHECK_THROWS_AS(op.set_secant(x), std::invalid_argument);
  CHECK_THROWS_AS(op.apply_tangent(x, x), std::logic_error);
}

TEST_CASE("the locality order is a renumbering that brings neighbours together") {
  auto mesh = meshes::box(ElementType::tet4, {12, 12, 12}, {1, 1, 1});
  meshes::shuffle(mesh, 61);
  const LocalityOrder order = locality_order(mesh.view());
  const auto is_permutation = [](std::vector<std::int32_t> v, std::size_t size) {
    std::sort(v.begin(), v.end());
    for (std::size_t i = 0; i < v.size(); ++i)
      if (v[i] != static_cast<std::int32_t>(i)) return false;
    return v.size() == size;
  };
  CHECK(is_permutation(order.nodes, mesh.view().node_count()));
  CHECK(is_permutation(order.elements, mesh.view().element_count()));
  std::vector<double> rank(order.nodes.size());
  for (std::size_t i = 0; i < rank.size(); ++i) rank[order.nodes[i]] = static_cast<double>(i);
  double before = 0.0, after = 0.0;  // mean distance between the numbers of an element's first two nodes
  for (std::size_t e = 0; e < mesh.view().element_count(); ++e) {
    const auto a = mesh.connectivity[4 * e], b = mesh.connectivity[4 * e + 1];
    before += std::abs(static_cast<double>(a - b));
    after += std::abs(rank[a] - rank[b]);
  }
  CHECK(after < 0.2 * before);
}

namespace {

/// Returns the Hilbert index of a point of a 2^20 grid, computed bit by bit as in Skilling (2004).
std::uint64_t plain_hilbert(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1u << 19; q > 1; q >>= 1)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t swap = (x[0] ^ x[i]) & (q - 1);
      if (x[i] & q) {
        x[0] ^= q - 1;
      } else {
        x[0] ^= swap;
        x[i] ^= swap;
      }
    }
  for (std::size_t i = 1; i < 3; ++i) x[i] ^= x[i - 1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1u << 19; q > 1; q >>= 1)
    if (x[2] & q) t ^= q - 1;
  std::uint64_t key = 0;
  for (unsigned b = 20; b-- > 0;)
    for (const std::uint32_t xi : x) key = key << 1 | ((xi ^ t) >> b & 1u);
  return key;
}

}  // namespace

TEST_CASE("the locality order follows the Hilbert curve") {
  auto mesh = meshes::box(ElementType::tet4, {9, 9, 9}, {1, 1, 1});
  meshes::shuffle(mesh, 62);
  // The mesh is a cube of cubes, so the grid of the curve matches the coordinates.
  std::vector<std::pair<std::uint64_t, std::int32_t>> expected;
  for (std::size_t n = 0; n < mesh.view().node_count(); ++n) {
    std::array<std::uint32_t, 3> x{};
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = static_cast<std::uint32_t>(mesh.coordinates[3 * n + k] * ((1u << 20) - 1));
    expected.emplace_back(plain_hilbert(x), static_cast<std::int32_t>(n));
  }
  std::sort(expected.begin(), expected.end());
  const std::vector<std::int32_t> order = node_order(mesh.view());
  REQUIRE(order.size() == expected.size());
  std::size_t same = 0;
  for (std::size_t i = 0; i < order.size(); ++i) same += order[i] == expected[i].second ? 1 : 0;
  CHECK(same == order.size());
}
