// SPDX-License-Identifier: BSD-3-Clause
// Conventions of other codes: node orders, inverted elements, unreferenced nodes, y = αBx + βy, an assembled
// matrix.
#include "c_example.hpp"

#include <kacanov/cells.hpp>

namespace {

const kacanov::Cell& facts(std::int32_t element) {
  return kacanov::cell(static_cast<kacanov::ElementType>(element));
}

/// Moves node k of every `every`-th element to position to[k].
void reorder(Example& example, const std::vector<int>& to, std::size_t every = 1) {
  const std::size_t nodes = to.size();
  auto& connectivity = example.mesh.connectivity;
  for (std::size_t e = 0; e < connectivity.size() / nodes; e += every) {
    std::vector<std::int32_t> moved(nodes);
    for (std::size_t a = 0; a < nodes; ++a) moved[to[a]] = connectivity[e * nodes + a];
    std::copy(moved.begin(), moved.end(), connectivity.begin() + static_cast<std::ptrdiff_t>(e * nodes));
  }
  example.description.connectivity = connectivity.data();
}

std::vector<double> product(const Handle& op, const double* u, const Vector& x) {
  std::size_t entries = 0;
  REQUIRE(kacanov_matrix_entries(op.get(), x.size(), &entries) == KACANOV_OK);
  std::vector<std::int64_t> first(x.size() + 1);
  std::vector<std::int32_t> column(entries);
  Vector value(entries), y(x.size(), 0.0);
  REQUIRE(kacanov_matrix(op.get(), x.size(), u, entries, first.data(), column.data(), value.data()) ==
          KACANOV_OK);
  CHECK(first.back() == static_cast<std::int64_t>(entries));
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::int64_t k = first[i]; k < first[i + 1]; ++k) {
      if (k > first[i]) CHECK(column[k - 1] < column[k]);
      y[i] += value[k] * x[column[k]];
    }
  return y;
}

}  // namespace

TEST_CASE("elements may come in the node orders of VTK, Basix and deal.II") {
  for (const std::int32_t element : all_elements) {
    CAPTURE(element);
    Example plain(element);
    const Vector x = random_vector(plain.n(), 2), want = applied(plain.create(), x);
    for (const std::string name : {"gmsh", "vtk", "basix", "dealii"}) {
      CAPTURE(name);
      Example other(element);
      const auto order = name == "gmsh"  ? std::span<const std::int8_t>()
                         : name == "vtk" ? facts(element).vtk_order
                                         : facts(element).basix_order;
      std::vector<int> to(facts(element).nodes);
      for (std::size_t k = 0; k < to.size(); ++k) to[order.empty() ? k : order[k]] = static_cast<int>(k);
      reorder(other, to);
      other.description.node_order = name.c_str();
      std::string text;
      if (name == "dealii" && element == KACANOV_TET10) {
        CHECK(other.fault(text) == KACANOV_ERROR_VALUE);
        CHECK(text.find("tet10") != std::string::npos);
      } else {
        CHECK(applied(other.create(), x) == want);
      }
    }
  }
  Example odd;
  odd.description.node_order = "ansys";
  std::string text;
  CHECK(odd.fault(text) == KACANOV_ERROR_VALUE);
  CHECK(text.find("node_order") != std::string::npos);
}

TEST_CASE("inverted elements are turned where that is asked for") {
  for (const std::int32_t element : all_elements) {
    CAPTURE(element);
    Example plain(element);
    const Vector x = random_vector(plain.n(), 2), want = applied(plain.create(), x);
    // Reflected node orders. The library repairs an inverted element by swapping corners 1 and 2 of
    // simplices, and 1 and 3 of the other types.
    const std::map<std::int32_t, std::vector<int>> mirror{{KACANOV_TRI3, {0, 2, 1}},
                                                          {KACANOV_TET4, {1, 0, 2, 3}},
                                                          {KACANOV_TET10, {0, 2, 1, 3, 6, 5, 4, 7, 9, 8}},
                                                          {KACANOV_HEX8, {4, 5, 6, 7, 0, 1, 2, 3}},
                                                          {KACANOV_QUAD4, {1, 0, 3, 2}}};
    Example inverted(element);
    reorder(inverted, mirror.at(element), 3);
    std::string text;
    CHECK(inverted.fault(text) == KACANOV_ERROR_MESH);
    inverted.description.turn_inverted = 1;
    CHECK(distance(applied(inverted.create(), x), want) < 1e-13);
    inverted.mesh.connectivity[1] = 1 << 20;
    CHECK(inverted.fault(text) == KACANOV_ERROR_MESH);
    CHECK(text.find("connectivity") != std::string::npos);
  }
}

TEST_CASE("nodes of no element: rows of zeros, refused, or rows of the identity") {
  Example example(KACANOV_HEX8);
  const std::size_t n = example.n();
  const Vector before = applied(example.create(), Vector(n, 1.0));
  example.mesh.coordinates.insert(example.mesh.coordinates.end(), {9.0, 9.0, 9.0});
  example.description.coordinates = example.mesh.coordinates.data();
  example.description.nodes = example.mesh.coordinates.size() / 3;
  example.description.single = 1;
  const Vector x = random_vector(n + 3, 1);
  const Vector zeros = applied(example.create(), x);
  for (std::size_t i = n; i < n + 3; ++i) CHECK(zeros[i] == 0.0);

  std::string text;
  example.description.orphans = KACANOV_ORPHANS_REFUSED;
  CHECK(example.fault(text) == KACANOV_ERROR_MESH);
  CHECK(text.find("node " + std::to_string(n / 3)) != std::string::npos);
  example.description.orphans = 3;
  CHECK(example.fault(text) == KACANOV_ERROR_VALUE);

  example.description.orphans = KACANOV_ORPHANS_UNIT;
  const Handle op = example.create();
  REQUIRE(kacanov_update_tangent(op.get(), n + 3, random_vector(n + 3, 4, 0.01).data()) == KACANOV_OK);
  Vector want = applied(op, x), y(n + 3), diagonal(n + 3), blocks(3 * (n + 3));
  for (std::size_t i = n; i < n + 3; ++i) CHECK(want[i] == x[i]);
  double dot = 0.0, sum = 0.0;
  REQUIRE(kacanov_apply_dot(op.get(), n + 3, x.data(), y.data(), &dot) == KACANOV_OK);
  for (std::size_t i = 0; i < n + 3; ++i) sum += x[i] * y[i];
  CHECK(dot == doctest::Approx(sum).epsilon(1e-12));
  REQUIRE(kacanov_apply_tangent_dot(op.get(), n + 3, x.data(), y.data(), &dot) == KACANOV_OK);
  CHECK(y[n] == x[n]);
  REQUIRE(kacanov_diagonal(op.get(), n + 3, diagonal.data()) == KACANOV_OK);
  REQUIRE(kacanov_block_diagonal(op.get(), blocks.size(), blocks.data()) == KACANOV_OK);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(diagonal[n + i] == 1.0);
    for (std::size_t j = 0; j < 3; ++j) CHECK(blocks[3 * (n + i) + j] == (i == j ? 1.0 : 0.0));
  }
  CHECK(distance(product(op, nullptr, x), want) < 1e-13);
}

TEST_CASE("the matrix is the operator's and the tangent's, and sums are what they say") {
  for (const std::int32_t element : all_elements) {
    CAPTURE(element);
    Example example(element);
    const Handle op = example.create();
    const std::size_t n = example.n();
    const Vector u = random_vector(n, 1, 0.05), x = random_vector(n, 2), z = random_vector(n, 3);
    REQUIRE(kacanov_update_tangent(op.get(), n, u.data()) == KACANOV_OK);
    const Vector y = applied(op, x);
    CHECK(distance(product(op, nullptr, x), y) < 1e-12);
    Vector tangent(n), sum = z;
    REQUIRE(kacanov_apply_tangent(op.get(), n, x.data(), tangent.data()) == KACANOV_OK);
    CHECK(distance(product(op, u.data(), x), tangent) < 1e-6);  // direction in single precision
    REQUIRE(kacanov_apply_add(op.get(), n, 2.0, x.data(), -0.5, sum.data()) == KACANOV_OK);
    for (std::size_t i = 0; i < n; ++i) CHECK(sum[i] == 2.0 * y[i] - 0.5 * z[i]);
    Vector unread(n, nan_value);
    REQUIRE(kacanov_apply_add(op.get(), n, 1.0, x.data(), 0.0, unread.data()) == KACANOV_OK);
    CHECK(unread == y);
    std::size_t entries = 0;
    REQUIRE(kacanov_matrix_entries(op.get(), n, &entries) == KACANOV_OK);
    CHECK(kacanov_matrix(op.get(), n, nullptr, entries - 1, nullptr, nullptr, nullptr) == KACANOV_ERROR_SIZE);
  }
}

TEST_CASE("the tangent on several vectors and in single precision is the tangent") {
  for (const std::int32_t element : all_elements) {
    CAPTURE(element);
    Example example(element, 3);
    example.description.single = 1;
    const Handle op = example.create();
    const std::size_t n = example.n();
    const Vector u = random_vector(n, 3, 0.03), x = random_vector(7 * n, 4);
    const std::vector<float> small(x.begin(), x.end());
    Vector y(n), many(7 * n), diagonal(n);
    std::vector<float> image(7 * n);
    CHECK(kacanov_apply_tangent_many(op.get(), n, 7, x.data(), many.data()) == KACANOV_ERROR_STATE);
    CHECK(kacanov_apply_tangent_float(op.get(), n, small.data(), image.data()) == KACANOV_ERROR_STATE);
    const std::int32_t held[] = {0, 4};
    REQUIRE(kacanov_constrain(op.get(), 2, held) == KACANOV_OK);
    for (const double size : {1.0, 0.5}) {
      Vector at = u;
      for (double& v : at) v *= size;
      REQUIRE(kacanov_update_tangent(op.get(), n, at.data()) == KACANOV_OK);
      // A later update of g does not change the frozen tangent.
      REQUIRE(kacanov_update(op.get(), n, Vector(n, 0.0).data()) == KACANOV_OK);
      REQUIRE(kacanov_apply_tangent_many(op.get(), n, 7, x.data(), many.data()) == KACANOV_OK);
      REQUIRE(kacanov_apply_tangent_many_float(op.get(), n, 7, small.data(), image.data()) == KACANOV_OK);
      for (std::size_t v = 0; v < 7; ++v) {
        REQUIRE(kacanov_apply_tangent(op.get(), n, &x[v * n], y.data()) == KACANOV_OK);
        const auto begin = static_cast<std::ptrdiff_t>(v * n), end = begin + static_cast<std::ptrdiff_t>(n);
        CHECK(distance(Vector(many.begin() + begin, many.begin() + end), y) < 1e-13);
        CHECK(distance(Vector(image.begin() + begin, image.begin() + end), y) < 5e-6);
      }
      double dot = 0.0, single_dot = 0.0;
      REQUIRE(kacanov_apply_tangent_dot(op.get(), n, x.data(), y.data(), &dot) == KACANOV_OK);
      REQUIRE(kacanov_apply_tangent_dot_float(op.get(), n, small.data(), image.data(), &single_dot) ==
              KACANOV_OK);
      CHECK(single_dot == doctest::Approx(dot).epsilon(5e-6));
      REQUIRE(kacanov_diagonal_tangent(op.get(), n, diagonal.data()) == KACANOV_OK);
      REQUIRE(kacanov_diagonal_tangent_float(op.get(), n, image.data()) == KACANOV_OK);
      CHECK(distance(Vector(image.begin(), image.begin() + static_cast<std::ptrdiff_t>(n)), diagonal) < 5e-6);
      REQUIRE(kacanov_apply_float(op.get(), n, small.data(), image.data()) == KACANOV_OK);
      CHECK(distance(Vector(image.begin(), image.begin() + static_cast<std::ptrdiff_t>(n)),
                     applied(op, Vector(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n)))) < 5e-6);
    }
  }
}
