// SPDX-License-Identifier: BSD-3-Clause
// Invalid input to the C interface: every case returns a code with a message and does no harm.
#include <doctest/doctest.h>

#include <cstring>
#include <functional>

#include "c_example.hpp"

TEST_CASE("bad descriptions have a code and name what is wrong") {
  struct Case {
    std::function<void(Example&)> spoil;
    int code;
    std::string says;
  };
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::vector<Case> cases = {
      {[](Example& e) { e.description.coordinates = nullptr; }, KACANOV_ERROR_NULL, "coordinates"},
      {[](Example& e) { e.description.connectivity = nullptr; }, KACANOV_ERROR_NULL, "connectivity"},
      {[](Example& e) { e.description.law = nullptr; }, KACANOV_ERROR_NULL, "law"},
      {[](Example& e) { e.description.element = 9; }, KACANOV_ERROR_VALUE, "element"},
      {[](Example& e) { e.description.threads = -1; }, KACANOV_ERROR_VALUE, "threads"},
      {[](Example& e) { e.description.index_base = 2; }, KACANOV_ERROR_VALUE, "index_base"},
      {[](Example& e) { e.description.instruction_set = "abacus"; }, KACANOV_ERROR_VALUE, "abacus"},
      {[](Example& e) { e.description.single = 2; }, KACANOV_ERROR_VALUE, "single"},
      {[](Example& e) { e.description.borrow = 2; }, KACANOV_ERROR_VALUE, "borrow"},
      {[](Example& e) { e.description.borrow = e.description.index_base = 1; }, KACANOV_ERROR_VALUE,
       "borrow"},
      {[](Example& e) { e.description.nodes = 0; }, KACANOV_ERROR_SIZE, "nodes"},
      {[](Example& e) { e.description.nodes = std::size_t{1} << 40; }, KACANOV_ERROR_SIZE, "nodes"},
      {[](Example& e) { e.description.elements = 0; }, KACANOV_ERROR_SIZE, "elements"},
      {[](Example& e) { e.description.element_stride = 3; }, KACANOV_ERROR_SIZE, "element_stride"},
      {[](Example& e) {
         e.description.laws = 70000;
         e.laws.resize(70000);
         e.description.law = e.laws.data();
       },
       KACANOV_ERROR_SIZE, "laws"},
      {[](Example& e) { e.mesh.connectivity[9] = -1; }, KACANOV_ERROR_MESH, "element 2 refers to node -1"},
      {[](Example& e) { e.description.index_base = 1; }, KACANOV_ERROR_MESH, "element 0 refers to node -1"},
      {[](Example& e) { e.mesh.connectivity[9] = 27; }, KACANOV_ERROR_MESH, "27"},
      {[](Example& e) { std::swap(e.mesh.connectivity[4], e.mesh.connectivity[5]); }, KACANOV_ERROR_MESH,
       "element 1 is inverted"},
      {[](Example& e) { e.mesh.connectivity[4] = e.mesh.connectivity[5]; }, KACANOV_ERROR_MESH,
       "element 1 is degenerate"},
      {[](Example& e) { e.mesh.coordinates[7] = nan_value; }, KACANOV_ERROR_MESH, "node 2"},
      {[](Example& e) { e.mesh.coordinates[7] = inf; }, KACANOV_ERROR_MESH, "node 2"},
      {[](Example& e) { e.law_of_element[3] = 2; }, KACANOV_ERROR_LAW, "law_of_element[3]"},
      {[](Example& e) { e.laws[0].kind = 17; }, KACANOV_ERROR_LAW, "law[0].kind"},
      {[](Example& e) { e.laws[0].squared = 7; }, KACANOV_ERROR_LAW, "law[0].squared"},
      {[](Example& e) { e.laws[1].mean_dilatation = 2; }, KACANOV_ERROR_LAW, "law[1].mean_dilatation"},
      {[](Example& e) { e.laws[1].mean_dilatation = 1; }, KACANOV_ERROR_LAW,
       "law[1].mean_dilatation"},  // tet4
      {[](Example& e) { e.laws[0].bulk = 0.0; }, KACANOV_ERROR_LAW, "law[0].bulk"},
      {[](Example& e) { e.laws[0].shear = inf; }, KACANOV_ERROR_LAW, "law[0].shear"},
      {[](Example& e) { e.laws[0].x0 = nan_value; }, KACANOV_ERROR_LAW, "law[0].x0"},
      {[](Example& e) { e.laws[0].kind = KACANOV_POWER; }, KACANOV_ERROR_LAW, "law[0].n"},
      {[](Example& e) { e.laws[0].kind = KACANOV_SATURATING; }, KACANOV_ERROR_LAW, "law[0].q"},
      {[](Example& e) {
         e.laws[0].kind = KACANOV_LINEAR_HARDENING;
         e.laws[0].gamma = 2.0;
       },
       KACANOV_ERROR_LAW, "law[0].gamma"},
      {[](Example& e) {
         e.laws[0].kind = KACANOV_LINEAR_HARDENING;
         e.laws[0].gamma = 0.0;
       },
       KACANOV_ERROR_LAW, "law[0].gamma: expected a number > 0 and ≤ 1, got 0"},
      {[](Example& e) { e.laws[0].kind = KACANOV_TABLE; }, KACANOV_ERROR_NULL, "law[0].table_x"},
  };
  for (const Case& bad : cases) {
    CAPTURE(bad.says);
    Example example;
    bad.spoil(example);
    std::string text;
    CHECK(example.fault(text) == bad.code);
    INFO(text);
    CHECK(text.find(bad.says) != std::string::npos);
  }
}

TEST_CASE("tables are checked point by point") {
  const auto code = [](const Vector& x, const Vector& s) {
    Example example;
    example.laws[0].kind = KACANOV_TABLE;
    example.laws[0].table_size = x.size();
    example.laws[0].table_x = x.data();
    example.laws[0].table_s = s.data();
    std::string text;
    kacanov_operator* op = nullptr;
    const int result = kacanov_create(&example.description, &op, nullptr, 0);
    kacanov_destroy(op);
    return result;
  };
  CHECK(code({0, 1, 2}, {0, 2, 3}) == KACANOV_OK);
  CHECK(code({0, 1, 2}, {0, 2, 2}) == KACANOV_ERROR_LAW);  // a plateau: the displacement is not unique
  CHECK(code({0}, {0}) == KACANOV_ERROR_LAW);
  CHECK(code({1, 2}, {1, 2}) == KACANOV_ERROR_LAW);
  CHECK(code({0, 1, 1}, {0, 2, 3}) == KACANOV_ERROR_LAW);
  CHECK(code({0, 1, 2}, {0, 2, 1}) == KACANOV_ERROR_LAW);
  CHECK(code({0, 1, 2}, {0, 2, 5}) == KACANOV_ERROR_LAW);
  CHECK(code({0, 1, 2}, {0, nan_value, 5}) == KACANOV_ERROR_LAW);
}

TEST_CASE("a hexahedron inverted at one point only is found") {
  Example example(KACANOV_HEX8, 1);
  for (std::size_t c = 0; c < 3; ++c)
    example.mesh.coordinates[3 * 7 + c] = 0.2;  // a corner moved beyond the centre of the element
  std::string text;
  CHECK(example.fault(text) == KACANOV_ERROR_MESH);
  CHECK(text.find("element 0 is inverted") != std::string::npos);
}

TEST_CASE("meshes of any size, place and direction are accepted, their mirror images are not") {
  for (const std::int32_t element : {KACANOV_TRI3, KACANOV_TET4, KACANOV_TET10, KACANOV_HEX8, KACANOV_QUAD4})
    for (const double size : {1e-6, 1.0, 1e6})
      for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
        CAPTURE(element);
        CAPTURE(size);
        CAPTURE(angle);
        Example example(element);
        const std::size_t dim = example.mesh.dim;
        for (std::size_t i = 0; i < example.n(); i += dim)
          for (std::size_t c = 0; c + 1 < dim; ++c) {  // rotate about z, then about x
            double &p = example.mesh.coordinates[i + c], &q = example.mesh.coordinates[i + c + 1];
            const double turned = p * std::cos(angle) - q * std::sin(angle);
            q = p * std::sin(angle) + q * std::cos(angle);
            p = turned;
          }
        for (double& v : example.mesh.coordinates) v = size * (v - 5.0);
        example.create();
        for (std::size_t i = 0; i < example.n(); i += dim) example.mesh.coordinates[i] *= -1.0;
        std::string text;
        CHECK(example.fault(text) == KACANOV_ERROR_MESH);
        CHECK(text.find("element 0 is inverted") != std::string::npos);
      }
}

TEST_CASE("bad vectors have a code and leave the state alone") {
  const Example example;
  const Handle op = example.create();
  const std::size_t n = example.n(), points = example.mesh.elements();
  const Vector x = random_vector(n, 5, 0.1);
  Vector y(n), g(points, 1.0), blocks(3 * n);
  double value = 0.0;
  REQUIRE(kacanov_update(op.get(), n, x.data()) == KACANOV_OK);
  CHECK(std::string(kacanov_message(op.get())).empty());
  const Vector want = applied(op, x);

  CHECK(kacanov_apply(op.get(), n - 3, x.data(), y.data()) == KACANOV_ERROR_SIZE);
  CHECK(kacanov_apply(op.get(), n, nullptr, y.data()) == KACANOV_ERROR_NULL);
  CHECK(kacanov_apply(op.get(), n, x.data(), nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_apply(op.get(), n, y.data(), y.data()) == KACANOV_ERROR_SIZE);
  CHECK(std::string(kacanov_message(op.get())) == "x and y overlap");
  CHECK(kacanov_apply_dot(op.get(), n, x.data(), y.data(), nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_apply_tangent(op.get(), n, x.data(), y.data()) == KACANOV_ERROR_STATE);
  CHECK(kacanov_diagonal(op.get(), n + 1, y.data()) == KACANOV_ERROR_SIZE);
  CHECK(kacanov_block_diagonal(op.get(), n, blocks.data()) == KACANOV_ERROR_SIZE);
  CHECK(kacanov_secant(op.get(), points, nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_set_secant(op.get(), points - 1, g.data()) == KACANOV_ERROR_SIZE);
  g[4] = -1.0;
  CHECK(kacanov_set_secant(op.get(), points, g.data()) == KACANOV_ERROR_VALUE);
  CHECK(kacanov_energy(op.get(), n, x.data(), nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_residual(op.get(), n, nullptr, y.data()) == KACANOV_ERROR_NULL);
  CHECK(kacanov_inspect(op.get(), nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_stress(op.get(), n, x.data(), nullptr) == KACANOV_ERROR_NULL);
  auto fields = sized<kacanov_fields>();
  fields.elements = points + 1;
  CHECK(kacanov_stress(op.get(), n, x.data(), &fields) == KACANOV_ERROR_SIZE);

  Vector bad = x;
  bad[11] = nan_value;
  fields.elements = points;
  for (const int code :
       {kacanov_update(op.get(), n, bad.data()), kacanov_update_tangent(op.get(), n, bad.data()),
        kacanov_residual(op.get(), n, bad.data(), y.data()), kacanov_energy(op.get(), n, bad.data(), &value),
        kacanov_residual_energy_update(op.get(), n, bad.data(), y.data(), &value),
        kacanov_stress(op.get(), n, bad.data(), &fields)})
    CHECK(code == KACANOV_ERROR_VALUE);
  CHECK(std::string(kacanov_message(op.get())) == "u[11] is not finite");
  CHECK(applied(op, x) == want);
}

TEST_CASE("no call takes a null handle, and none a vector of another length") {
  Example example;
  example.description.single = 1;
  const Handle op = example.create();
  const std::size_t n = example.n();
  Vector x(n), y(3 * n);
  std::vector<float> a(n), b(n);
  double value = 0.0;
  auto fields = sized<kacanov_fields>();
  fields.elements = example.mesh.elements();
  auto information = sized<kacanov_information>();
  using Call = std::function<int(kacanov_operator*, std::size_t)>;
  const std::vector<Call> with_length = {
      [&](kacanov_operator* h, std::size_t m) { return kacanov_update(h, m, x.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_apply(h, m, x.data(), y.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_apply_dot(h, m, x.data(), y.data(), &value); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_apply_many(h, m, 1, x.data(), y.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_update_tangent(h, m, x.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_apply_tangent(h, m, x.data(), y.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_diagonal(h, m, y.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_block_diagonal(h, 3 * m, y.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_diagonal_tangent(h, m, y.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_block_diagonal_tangent(h, 3 * m, y.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_residual(h, m, x.data(), y.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_energy(h, m, x.data(), &value); },
      [&](kacanov_operator* h, std::size_t m) {
        return kacanov_residual_energy_update(h, m, x.data(), y.data(), &value);
      },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_apply_float(h, m, a.data(), b.data()); },
      [&](kacanov_operator* h, std::size_t m) {
        return kacanov_apply_dot_float(h, m, a.data(), b.data(), &value);
      },
      [&](kacanov_operator* h, std::size_t m) {
        return kacanov_apply_many_float(h, m, 1, a.data(), b.data());
      },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_diagonal_float(h, m, b.data()); },
      [&](kacanov_operator* h, std::size_t m) { return kacanov_stress(h, m, x.data(), &fields); }};
  for (std::size_t i = 0; i < with_length.size(); ++i) {
    CAPTURE(i);
    CHECK(with_length[i](op.get(), n) == KACANOV_OK);
    CHECK(with_length[i](nullptr, n) == KACANOV_ERROR_NULL);
    for (const std::size_t wrong : {std::size_t{0}, n - 1, n + 1, std::size_t{1} << 61}) {
      CHECK(with_length[i](op.get(), wrong) == KACANOV_ERROR_SIZE);
      CHECK(std::string(kacanov_message(op.get())).find("expected") != std::string::npos);
    }
  }
  const std::size_t points = example.mesh.elements();
  CHECK(kacanov_secant(nullptr, points, y.data()) == KACANOV_ERROR_NULL);
  CHECK(kacanov_set_secant(nullptr, points, y.data()) == KACANOV_ERROR_NULL);
  CHECK(kacanov_inspect(nullptr, &information) == KACANOV_ERROR_NULL);
  CHECK(kacanov_locality_order(nullptr, 0, nullptr, 0, nullptr) == KACANOV_ERROR_NULL);
}

TEST_CASE(
    "whatever numbers a mesh is made of, creating it fails with words or gives an operator that works") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::vector<double> odd_values{nan_value, inf, -inf, 1e308, -1e308, 1e-308, 5e-324, 0.0, -0.0, 1e16};
  const std::vector<std::int32_t> odd_nodes{
      -1, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max(), 0, 1, 26, 27};
  std::mt19937 random(3);
  std::size_t refused = 0, taken = 0;
  for (const std::int32_t element : {KACANOV_TRI3, KACANOV_TET4, KACANOV_TET10, KACANOV_HEX8, KACANOV_QUAD4})
    for (int repeat = 0; repeat < 100; ++repeat) {
      Example example(element);
      example.description.index_base = repeat % 2;
      if (repeat % 2 == 1)
        for (std::int32_t& node : example.mesh.connectivity) ++node;
      if (repeat % 4 < 2)
        example.mesh.coordinates[random() % example.n()] = odd_values[random() % odd_values.size()];
      else
        example.mesh.connectivity[random() % example.mesh.connectivity.size()] =
            odd_nodes[random() % odd_nodes.size()];
      kacanov_operator* op = nullptr;
      char message[256];
      const int code = kacanov_create(&example.description, &op, message, sizeof message);
      const Handle owner(op);
      CHECK((code == KACANOV_OK) == (op != nullptr));
      if (code == KACANOV_OK) {
        applied(owner, random_vector(example.n(), 1));
        ++taken;
      } else {
        CHECK(code == KACANOV_ERROR_MESH);
        CHECK(std::strlen(message) > 10);
        ++refused;
      }
    }
  CHECK(refused > 200);
  CHECK(taken > 20);
}

TEST_CASE("null handles and short message buffers do no harm") {
  double value = 0.0;
  CHECK(kacanov_apply(nullptr, 0, &value, &value) == KACANOV_ERROR_NULL);
  CHECK(kacanov_set_laws(nullptr, 0, nullptr, 0, nullptr) == KACANOV_ERROR_NULL);
  CHECK(std::strlen(kacanov_message(nullptr)) > 0);
  kacanov_destroy(nullptr);
  CHECK(kacanov_elastic_law(1.0, 0.5, nullptr) == KACANOV_ERROR_NULL);
  auto law = sized<kacanov_law>();
  CHECK(kacanov_elastic_law(1.0, 0.5, &law) == KACANOV_ERROR_LAW);
  CHECK(kacanov_elastic_law(nan_value, 0.3, &law) == KACANOV_ERROR_LAW);

  char message[8] = "#######";
  kacanov_operator* op = nullptr;
  const Example example;
  CHECK(kacanov_create(nullptr, &op, message, 5) == KACANOV_ERROR_NULL);
  CHECK(std::string(message) == "desc");
  CHECK(message[5] == '#');
  CHECK(kacanov_create(&example.description, nullptr, nullptr, 0) == KACANOV_ERROR_NULL);
}
