// SPDX-License-Identifier: BSD-3-Clause
// The fast operator against the reference, for every element type, instruction set, thread count and kind of
// mesh; input that it rejects.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/locality.hpp>
#include <kacanov/operator.hpp>
#include "../sanitized.hpp"
#include "bodies.hpp"

using namespace kacanov;

using test::difference;
using test::OwnedBody;

namespace {

/// Returns the instruction sets that this build and this processor support.
std::vector<std::string> instruction_sets() {
  meshes::OwnedMesh mesh{ElementType::tri3, {0, 0, 1, 0, 0, 1}, {0, 1, 2}};
  const auto body = test::with_one_law(mesh, elastic_law(1, 0.3));
  std::vector<std::string> sets;
  for (const std::string name : {"plain", "avx2", "avx512"}) {
    try {
      const Operator op(body.body(), {1, name});
      sets.push_back(name);
    } catch (const std::invalid_argument&) {
    }
  }
  if (testing::sanitized && sets.size() > 2) sets.erase(sets.begin() + 1);  // smallest and largest blocks
  return sets;
}

/// The first `count` elements of a shuffled mesh: loosely connected pieces, and nodes without elements.
meshes::OwnedMesh some_elements(meshes::OwnedMesh mesh, std::size_t count, unsigned seed) {
  meshes::shuffle(mesh, seed);
  mesh.connectivity.resize(count * static_cast<std::size_t>(nodes_per_element(mesh.type)));
  return mesh;
}

void stretch(meshes::OwnedMesh& mesh, double factor) {
  const std::size_t dim = dimension(mesh.type);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += dim) mesh.coordinates[i] *= factor;
}

/// Meshes of one to a few hundred elements: perturbed, irregular and stretched.
std::vector<OwnedBody> bodies(ElementType type) {
  std::vector<OwnedBody> all;
  const double amount = cell(type).order == 2 ? 0.04 : 0.12;
  auto whole = meshes::box(type, {3, 2, 3}, {1, 1, 1});
  meshes::jitter(whole, amount, 1);
  const std::size_t count = whole.view().element_count();
  for (const std::size_t size : {1, 2, 3, 5, 7, 8, 9, 12, 16, 17, 25, 40})
    if (size <= count)
      all.push_back(test::with_one_law(some_elements(whole, size, unsigned(size)), test::every_law()[1]));
  all.push_back(test::with_every_law(whole, 2));
  auto sheared = meshes::box(type, {7, 4, 3}, {1, 1, 1});  // hex8: parallelepipeds, some distorted below
  const std::size_t dim = dimension(type);
  for (std::size_t i = 0; i < sheared.coordinates.size(); i += dim) {
    double* x = &sheared.coordinates[i];
    x[0] += 0.4 * x[1], x[1] += 0.3 * x[dim - 1];
    if (dim == 3 && x[2] < 0.4) x[2] *= 1.0 + 0.2 * x[0] * x[1];
  }
  all.push_back(test::with_every_law(sheared, 6));
  if (testing::sanitized) return all;  // the remaining meshes differ in their numbers, not in the code paths
  stretch(sheared, 1000.0);
  all.push_back(test::with_one_law(sheared, test::every_law()[3]));
  auto long_box = meshes::box(type, {9, 4, 4}, {4, 1, 1});
  meshes::jitter(long_box, amount, 3);
  if (type == ElementType::tet4) meshes::flip(long_box, 3, 4);
  meshes::straighten(long_box);
  meshes::shuffle(long_box, 5);
  all.push_back(test::with_one_law(long_box, test::every_law()[4]));
  stretch(long_box, 1000.0);
  all.push_back(test::with_one_law(long_box, test::every_law()[1]));
  return all;
}

std::vector<double> some_secant(std::size_t count) {
  auto g = test::random_vector(count, 21, 0.15);
  for (double& value : g) value += 0.25;
  return g;
}

/// Calls check(operator) for every instruction set and thread count.
template <class AnyOperator = Operator, class Check>
void for_every_operator(const Body& body, Check&& check) {
  for (const std::string& set : instruction_sets())
    for (const int threads : {1, 2}) {
      CAPTURE(static_cast<int>(body.mesh.type));
      CAPTURE(body.mesh.element_count());
      CAPTURE(set);
      CAPTURE(threads);
      AnyOperator op(body, {threads, set});
      CHECK(op.instruction_set() == set);
      check(op);
    }
}

/// Calls check(body) for every element type and kind of mesh, so that expected values are computed once per
/// body and serve all operators.
template <class Check>
void for_every_body(Check&& check) {
  for (const ElementType type : test::all_types)
    for (const OwnedBody& owned : bodies(type)) check(owned.body());
}

/// Cells across the meshes that fill many blocks; fewer under the sanitizers, which run ten times slower.
constexpr int thick = testing::sanitized ? 12 : 24;

/// Displacements that take some points beyond yield, also on a stretched mesh.
std::vector<double> some_state(const Body& body, unsigned seed) {
  double longest = 0.0;
  for (const double x : body.mesh.coordinates) longest = std::max(longest, std::abs(x));
  return test::random_vector(body.unknowns(), seed, longest > 100.0 ? 1e-4 : 0.005);
}

}  // namespace

TEST_CASE("y = B x, its dot product and several right sides") {
  for_every_body([](const Body& body) {
    const std::size_t n = body.unknowns();
    const auto g = some_secant(body.secant_count());
    std::vector<double> many_x, expected_many, expected(n);
    for (unsigned v = 0; v < 7; ++v) {
      const auto x = test::random_vector(n, v);
      reference::apply(body, g, x, expected);
      many_x.insert(many_x.end(), x.begin(), x.end());
      expected_many.insert(expected_many.end(), expected.begin(), expected.end());
    }
    const auto x = std::span(many_x).first(n);
    const auto first = std::span(expected_many).first(n);
    for_every_operator(body, [&](Operator& op) {
      CHECK(op.unknowns() == n);
      op.set_secant(g);
      std::vector<double> back(g.size()), y(n, -1.0);
      op.secant(back);
      CHECK(back == g);
      op.apply(x, y);
      CHECK(difference(y, first) < 1e-13);
      std::vector<double> again(n, 7.0);
      const double xy = op.apply_dot(x, again);
      CHECK(again == y);
      CHECK(xy == doctest::Approx(test::dot(x, first)).epsilon(1e-12));
      std::vector<double> many_y(7 * n);
      op.apply_many(many_x, many_y, 7);
      CHECK(difference(many_y, expected_many) < 1e-13);
      CHECK(op.applications() == 9);
    });
  });
}

TEST_CASE("residual, energy, new g and tangent at a state") {
  for_every_body([](const Body& body) {
    const std::size_t n = body.unknowns();
    const auto u = some_state(body, 31), x = test::random_vector(n, 32);
    const std::vector<double> zero(n, 0.0);
    std::vector<double> expected(n), expected_tangent(n), expected_g(body.secant_count()),
        elastic(expected_g.size());
    reference::residual(body, u, expected);
    reference::secant(body, u, expected_g);
    reference::secant(body, zero, elastic);
    reference::apply_tangent(body, u, x, expected_tangent);
    const double energy = reference::energy(body, u);
    for_every_operator(body, [&](Operator& op) {
      std::vector<double> f(n), g(expected_g.size()), y(n), fused(n);
      op.residual(u, f);
      CHECK(difference(f, expected) < 1e-13);
      CHECK(op.energy(u) == doctest::Approx(energy).epsilon(1e-12));
      op.secant(g);
      CHECK(difference(g, elastic) < 1e-14);  // neither residual nor energy changed g = mu

      CHECK(op.residual_energy_update(u, fused) == doctest::Approx(energy).epsilon(1e-12));
      CHECK(fused == f);
      op.secant(g);
      CHECK(difference(g, expected_g) < 1e-12);
      op.apply(u, y);
      CHECK(difference(y, expected) < 1e-13);

      op.update(zero);
      op.update_tangent(u);
      const double xy = op.apply_tangent_dot(x, y);
      CHECK(xy == doctest::Approx(test::dot(x, y)).epsilon(1e-12));
      op.apply_tangent(x, y);
      CHECK(difference(y, expected_tangent) < 3e-7);  // the rank-one term is stored in single precision
      const auto first = y;
      op.update(zero);  // the frozen tangent does not change
      op.apply_tangent(x, y);
      CHECK(y == first);
    });
  });
}

TEST_CASE("diagonals") {
  for_every_body([](const Body& body) {
    const auto g = some_secant(body.secant_count()), u = some_state(body, 33);
    const std::size_t n = body.unknowns(), dim = static_cast<std::size_t>(dimension(body.mesh.type));
    std::vector<double> expected(n), expected_blocks(n * dim), expected_tangent(n * dim);
    reference::diagonal(body, g, expected);
    reference::block_diagonal(body, g, expected_blocks);
    reference::block_diagonal_tangent(body, u, expected_tangent);
    for_every_operator(body, [&](Operator& op) {
      op.set_secant(g);
      std::vector<double> actual(n), blocks(n * dim);
      op.diagonal(actual);
      CHECK(difference(actual, expected) < 1e-13);
      op.block_diagonal(blocks);
      CHECK(difference(blocks, expected_blocks) < 1e-13);
      std::vector<char> wanted(n / dim, 0);
      for (std::size_t node = 0; node < wanted.size(); node += 5) wanted[node] = 1;
      std::vector<double> some(n * dim, -1.0);
      op.block_diagonal(some, wanted);
      for (std::size_t i = 0; i < some.size(); ++i)
        if (wanted[i / (dim * dim)] != 0) CHECK(some[i] == blocks[i]);
      CHECK_THROWS_AS(op.block_diagonal_tangent(blocks), std::logic_error);
      op.update_tangent(u);
      op.set_secant(g);  // the frozen tangent does not change
      op.block_diagonal_tangent(blocks);
      CHECK(difference(blocks, expected_tangent) < 3e-7);  // the rank-one term is stored in single precision
      op.diagonal_tangent(actual);
      for (std::size_t i = 0; i < n; ++i) CHECK(actual[i] == blocks[i * dim + i % dim]);
    });
  });
}

TEST_CASE("divided as another operator: the same answers, whatever the precision, threads and early nodes") {
  const auto check = [](const Body& body, const Operator& like, const OperatorOptions& options) {
    const std::size_t n = body.unknowns();
    const auto x = test::random_vector(n, 31), u = some_state(body, 32), g = some_secant(body.secant_count());
    std::vector<double> product(n), force(n), y(n);
    reference::apply(body, g, x, product);
    reference::residual(body, u, force);
    Operator op(body, options, like);
    FloatOperator single(body, options, like);
    op.set_secant(g);
    op.apply(x, y);
    CHECK(difference(y, product) < 1e-13);
    op.residual(u, y);
    CHECK(difference(y, force) < 1e-12);
    std::vector<double> back(g.size());
    op.secant(back);
    CHECK(back == g);
    std::vector<float> z(n), again(n);
    single.set_secant(g);
    single.apply(std::vector<float>(x.begin(), x.end()), z);
    CHECK(difference(z, product) < 1e-5);
    FloatOperator twin(body, options, like);
    twin.set_secant(g);
    twin.apply(std::vector<float>(x.begin(), x.end()), again);
    CHECK(again == z);
  };
  for_every_body([&](const Body& body) {
    for_every_operator(body, [&](const Operator& like) {
      for (const int threads : {1, 3}) check(body, like, {threads, like.instruction_set()});
    });
  });
  auto mesh = meshes::box(ElementType::tet4, {24, 12, 12}, {2, 1, 1});
  meshes::jitter(mesh, 0.1, 33);
  meshes::shuffle(mesh, 34);
  const auto owned = test::with_every_law(std::move(mesh), 35);
  const std::vector<std::int32_t> early{17, 18, 2000};
  for (const int threads : {1, 2}) {
    const Operator like(owned.body(), {threads, {}});
    check(owned.body(), like, {2, {}, early});
    check(owned.body(), Operator(owned.body(), {1, {}}, like), {3, {}});
  }
  const auto other = test::with_every_law(meshes::box(ElementType::tet4, {2, 2, 2}, {1, 1, 1}), 36);
  CHECK_THROWS_WITH_AS(FloatOperator(owned.body(), {}, Operator(other.body())), doctest::Contains("like"),
                       std::invalid_argument);
}

TEST_CASE("the same bits in every run, on a mesh of many blocks") {
  auto mesh = meshes::box(ElementType::tet4, {2 * thick, thick, thick}, {2, 1, 1});
  meshes::jitter(mesh, 0.1, 7);
  meshes::flip(mesh, 1, 8);
  meshes::shuffle(mesh, 9);
  const auto owned = test::with_every_law(std::move(mesh), 10);
  const Body body = owned.body();
  const auto x = test::random_vector(body.unknowns(), 11), g = some_secant(body.secant_count());
  std::vector<double> expected(x.size()), y(x.size());
  reference::apply(body, g, x, expected);
  for (const int threads : {1, 2, 3, 7}) {
    CAPTURE(threads);
    Operator op(body, {threads, {}}), twin(body, {threads, {}});
    op.set_secant(g);
    twin.set_secant(g);
    const double dot = op.apply_dot(x, y);
    CHECK(difference(y, expected) < 1e-13);
    std::vector<double> z(x.size());
    for (int run = 0; run < 3; ++run) {
      CHECK(twin.apply_dot(x, z) == dot);
      CHECK(z == y);
    }
    CHECK(op.bytes() > 0);
  }
}

TEST_CASE("early nodes are done when they are said to be, and nothing else changes") {
  auto mesh = meshes::box(ElementType::tet4, {36, 18, 18}, {2, 1, 1});
  meshes::jitter(mesh, 0.1, 71);
  meshes::shuffle(mesh, 72);
  // Interface nodes as another process might share them: one end of the mesh, and one node elsewhere.
  std::vector<std::int32_t> early{17};
  for (std::size_t node = 0; node < mesh.view().node_count(); ++node)
    if (mesh.coordinates[3 * node] < 0.1) early.push_back(static_cast<std::int32_t>(node));
  const auto owned = test::with_every_law(std::move(mesh), 73);
  const Body body = owned.body();
  const auto x = test::random_vector(body.unknowns(), 74), g = some_secant(body.secant_count()),
             u = some_state(body, 75);
  const std::vector<float> xf(x.begin(), x.end());
  std::vector<double> expected(x.size());
  reference::apply(body, g, x, expected);
  for (const bool with : {true, false})
    for (const int threads : with && !testing::sanitized ? std::vector{1, 2, 3} : std::vector{2}) {
      CAPTURE(with);
      CAPTURE(threads);
      // Without interface nodes the callback comes first, and must still come.
      const OperatorOptions options{
          threads, {}, with ? std::span<const std::int32_t>(early) : std::span<const std::int32_t>{}};
      Operator op(body, options);
      FloatOperator single(body, options);
      op.set_secant(g);
      single.set_secant(g);
      const auto check = [&](auto& y, const auto& apply) {
        using Values = std::remove_reference_t<decltype(y)>;
        apply(OnInterfaceReady{});
        const Values whole = y;
        Values seen;
        std::fill(y.begin(), y.end(), 99);
        apply([&] {
          CHECK(seen.empty());
          seen = y;
        });
        CHECK(y == whole);
        REQUIRE(seen.size() == y.size());
        std::size_t ready = 0;
        for (const std::int32_t node : early)
          for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = 3 * static_cast<std::size_t>(node) + k;
            ready += seen[i] == whole[i] ? 1 : 0;
          }
        CHECK(ready == (with ? 3 * early.size() : 0));
        std::size_t rest = 0;
        for (std::size_t i = 0; i < y.size(); ++i) rest += seen[i] != whole[i] ? 1 : 0;
        CHECK(rest > y.size() / 8);  // most of the body is computed after the callback
        apply([&] { y[51] += 1; });
        CHECK(y[51] == (with ? whole[51] + 1 : whole[51]));
      };
      std::vector<double> y(x.size());
      std::vector<float> yf(x.size());
      double dot = 0.0;
      check(y, [&](const OnInterfaceReady& ready) { dot = op.apply_dot(x, y, ready); });
      CHECK(dot == doctest::Approx(test::dot(x, expected)).epsilon(1e-12));
      op.apply(x, y);
      CHECK(difference(y, expected) < 1e-13);
      check(yf, [&](const OnInterfaceReady& ready) { single.apply(xf, yf, ready); });
      op.update_tangent(u);
      check(y, [&](const OnInterfaceReady& ready) { dot = op.apply_tangent_dot(x, y, ready); });
      op.apply_tangent(x, y);
      CHECK(dot == doctest::Approx(test::dot(x, y)).epsilon(1e-12));
    }
  const std::vector<std::int32_t> nowhere{static_cast<std::int32_t>(body.mesh.node_count())};
  CHECK_THROWS_WITH_AS(Operator(body, {1, {}, nowhere}), doctest::Contains("early"), std::invalid_argument);
}

TEST_CASE("single precision agrees to five digits") {
  for_every_body([](const Body& body) {
    const std::size_t n = body.unknowns();
    const auto g = some_secant(body.secant_count()), x = test::random_vector(n, 51), u = some_state(body, 52);
    const std::vector<float> xf(x.begin(), x.end()), uf(u.begin(), u.end());
    std::vector<double> product(n), diagonal(n), residual(n), tangent(n);
    reference::apply(body, g, x, product);
    reference::diagonal(body, g, diagonal);
    reference::residual(body, u, residual);
    reference::apply_tangent(body, u, x, tangent);
    const double energy = reference::energy(body, u);
    for_every_operator<FloatOperator>(body, [&](FloatOperator& op) {
      std::vector<float> y(n), z(n);
      op.set_secant(g);
      op.apply(xf, y);
      CHECK(difference(y, product) < 1e-5);
      CHECK(op.apply_dot(xf, z) == doctest::Approx(test::dot(x, product)).epsilon(1e-5));
      CHECK(z == y);
      op.diagonal(z);
      CHECK(difference(z, diagonal) < 1e-5);

      op.residual(uf, y);
      CHECK(difference(y, residual) < 1e-4);
      CHECK(op.energy(uf) == doctest::Approx(energy).epsilon(1e-4));
      CHECK(op.residual_energy_update(uf, z) == doctest::Approx(energy).epsilon(1e-4));
      CHECK(z == y);
      op.update_tangent(uf);
      op.apply_tangent(xf, y);
      CHECK(difference(y, tangent) < 1e-3);
      CHECK(op.applications() == 3);
    });
  });
}

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
