// SPDX-License-Identifier: BSD-3-Clause
// The C interface: the same numbers as the reference, every way to hand over arrays, every bad input.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>

#include "kacanov.h"
#include "reference.hpp"
#include "small_meshes.hpp"

namespace {

using Vector = std::vector<double>;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

struct Destroy {
  void operator()(kacanov_operator* op) const { kacanov_destroy(op); }
};
using Handle = std::unique_ptr<kacanov_operator, Destroy>;

kacanov_law logarithmic() {
  kacanov_law law;
  REQUIRE(kacanov_elastic_law(2.0, 0.3, &law) == KACANOV_OK);
  law.kind = KACANOV_LOGARITHMIC;
  law.x0 = 0.02;
  return law;
}

/// A mesh, two laws (log law and linear) that alternate, and the description of both.
struct Example {
  SmallMesh mesh;
  std::vector<kacanov_law> laws;
  std::vector<std::uint16_t> law_of_element;
  kacanov_description description{};

  explicit Example(std::int32_t element = KACANOV_TET4, std::size_t n = 2) : mesh(small_mesh(element, n)) {
    laws = {logarithmic(), logarithmic()};
    laws[1].kind = KACANOV_LINEAR;
    for (std::size_t e = 0; e < mesh.elements(); ++e)
      law_of_element.push_back(static_cast<std::uint16_t>(e % 2));
    description.element = element;
    description.nodes = mesh.nodes();
    description.coordinates = mesh.coordinates.data();
    description.elements = mesh.elements();
    description.connectivity = mesh.connectivity.data();
    description.laws = laws.size();
    description.law = laws.data();
    description.law_of_element = law_of_element.data();
  }
  Example(const Example&) = delete;
  Example& operator=(const Example&) = delete;

  std::size_t n() const { return mesh.unknowns(); }

  Handle create() const {
    kacanov_operator* op = nullptr;
    char message[256];
    const int code = kacanov_create(&description, &op, message, sizeof message);
    INFO(message);
    REQUIRE(code == KACANOV_OK);
    return Handle(op);
  }

  /// The code; the message goes to `text`.
  int fault(std::string& text) const {
    auto* op = reinterpret_cast<kacanov_operator*>(&text);  // must be overwritten by null
    char message[256];
    const int code = kacanov_create(&description, &op, message, sizeof message);
    CHECK(op == nullptr);
    text = message;
    return code;
  }
};

Vector random_vector(std::size_t n, unsigned seed, double size = 1.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-size, size);
  Vector x(n);
  for (double& v : x) v = value(random);
  return x;
}

Vector applied(const Handle& op, const Vector& x) {
  Vector y(x.size());
  REQUIRE(kacanov_apply(op.get(), x.size(), x.data(), y.data()) == KACANOV_OK);
  return y;
}

double distance(const Vector& a, const Vector& b) {
  REQUIRE(a.size() == b.size());
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return difference / size;
}

}  // namespace

TEST_CASE("every element type gives the numbers of the reference") {
  for (const std::int32_t element : {KACANOV_TRI3, KACANOV_TET4, KACANOV_TET10, KACANOV_HEX8}) {
    CAPTURE(element);
    Example example(element);
    example.description.threads = 2;
    example.laws[0].mean_dilatation = element == KACANOV_HEX8;
    const Handle op = example.create();
    const SmallMesh& mesh = example.mesh;
    const std::size_t n = example.n();

    std::vector<kacanov::Law> laws(2, kacanov::elastic_law(2.0, 0.3));
    laws[0].kind = kacanov::Law::Kind::logarithmic;
    laws[0].x0 = 0.02;
    laws[0].mean_dilatation = element == KACANOV_HEX8;
    const kacanov::Body body{
        {static_cast<kacanov::ElementType>(element), mesh.coordinates, mesh.connectivity},
        laws,
        example.law_of_element};
    kacanov_information information;
    REQUIRE(kacanov_inspect(op.get(), &information) == KACANOV_OK);
    CHECK(information.unknowns == n);
    CHECK(information.elements == mesh.elements());
    CHECK(information.threads == 2);
    CHECK(information.bytes > 0);
    CHECK(std::string(information.instruction_set) != "");
    const std::size_t points = mesh.elements() * static_cast<std::size_t>(information.points_per_element);
    REQUIRE(points == body.secant_count());

    const Vector omega = random_vector(n, 1, 0.1), x = random_vector(n, 2);
    Vector g(points), want_g(points), y(n), want(n);
    REQUIRE(kacanov_update(op.get(), n, omega.data()) == KACANOV_OK);
    REQUIRE(kacanov_secant(op.get(), points, g.data()) == KACANOV_OK);
    kacanov::reference::secant(body, omega, want_g);
    CHECK(distance(g, want_g) < 1e-12);
    CHECK(distance(g, Vector(points, laws[0].shear)) > 0.1);  // the state is well beyond yield

    kacanov::reference::apply(body, want_g, x, want);
    CHECK(distance(applied(op, x), want) < 1e-12);
    double dot = 0.0, want_dot = 0.0;
    REQUIRE(kacanov_apply_dot(op.get(), n, x.data(), y.data(), &dot) == KACANOV_OK);
    for (std::size_t i = 0; i < n; ++i) want_dot += x[i] * want[i];
    CHECK(distance(y, want) < 1e-12);
    CHECK(dot == doctest::Approx(want_dot));

    REQUIRE(kacanov_diagonal(op.get(), n, y.data()) == KACANOV_OK);
    kacanov::reference::diagonal(body, want_g, want);
    CHECK(distance(y, want) < 1e-12);
    Vector blocks(n * mesh.dim), want_blocks(n * mesh.dim);
    REQUIRE(kacanov_block_diagonal(op.get(), blocks.size(), blocks.data()) == KACANOV_OK);
    kacanov::reference::block_diagonal(body, want_g, want_blocks);
    CHECK(distance(blocks, want_blocks) < 1e-12);

    REQUIRE(kacanov_update_tangent(op.get(), n, omega.data()) == KACANOV_OK);
    REQUIRE(kacanov_apply_tangent(op.get(), n, x.data(), y.data()) == KACANOV_OK);
    kacanov::reference::apply_tangent(body, omega, x, want);
    CHECK(distance(y, want) < 1e-6);  // its rank-one term is kept in single precision

    double energy = 0.0;
    REQUIRE(kacanov_residual(op.get(), n, omega.data(), y.data()) == KACANOV_OK);
    REQUIRE(kacanov_energy(op.get(), n, omega.data(), &energy) == KACANOV_OK);
    kacanov::reference::residual(body, omega, want);
    CHECK(distance(y, want) < 1e-12);
    CHECK(energy == doctest::Approx(kacanov::reference::energy(body, omega)));
    // Away from omega and back, in one pass.
    REQUIRE(kacanov_update(op.get(), n, Vector(n, 0.0).data()) == KACANOV_OK);
    double again = 0.0;
    REQUIRE(kacanov_residual_energy_update(op.get(), n, omega.data(), y.data(), &again) == KACANOV_OK);
    CHECK(distance(y, want) < 1e-12);
    CHECK(again == doctest::Approx(energy));
    REQUIRE(kacanov_secant(op.get(), points, g.data()) == KACANOV_OK);
    CHECK(distance(g, want_g) < 1e-12);

    Vector stress(6 * mesh.elements()), mises(mesh.elements()), want_stress(stress.size()),
        want_mises(mises.size());
    std::vector<std::uint8_t> plastic(mesh.elements()), want_plastic(mesh.elements());
    kacanov_fields fields{};
    fields.elements = mesh.elements();
    fields.stress = stress.data();
    fields.von_mises = mises.data();
    fields.plastic = plastic.data();
    REQUIRE(kacanov_stress(op.get(), n, omega.data(), &fields) == KACANOV_OK);
    kacanov::reference::fields(body, omega,
                               {.stress = want_stress,
                                .von_mises = want_mises,
                                .dev_strain = {},
                                .secant = {},
                                .plastic = want_plastic});
    CHECK(distance(stress, want_stress) < 1e-12);
    CHECK(distance(mises, want_mises) < 1e-12);
    CHECK(plastic == want_plastic);
  }
}

TEST_CASE("coordinates and connectivity may lie in any regular order") {
  Example plain;
  const Vector x = random_vector(plain.n(), 3);
  const Vector want = applied(plain.create(), x);

  SUBCASE("one array a component") {
    Vector columns(plain.n());
    for (std::size_t i = 0; i < plain.mesh.nodes(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        columns[c * plain.mesh.nodes() + i] = plain.mesh.coordinates[3 * i + c];
    plain.description.coordinates = columns.data();
    plain.description.node_stride = 1;
    plain.description.component_stride = plain.mesh.nodes();
    CHECK(applied(plain.create(), x) == want);
  }
  SUBCASE("records with other things in between, counted from 1") {
    Vector padded(5 * plain.mesh.nodes(), nan_value);
    std::vector<std::int32_t> rows(7 * plain.mesh.elements(), -5);
    for (std::size_t i = 0; i < plain.mesh.nodes(); ++i)
      for (std::size_t c = 0; c < 3; ++c) padded[5 * i + c] = plain.mesh.coordinates[3 * i + c];
    for (std::size_t e = 0; e < plain.mesh.elements(); ++e)
      for (std::size_t a = 0; a < 4; ++a) rows[7 * e + a] = plain.mesh.connectivity[4 * e + a] + 1;
    plain.description.coordinates = padded.data();
    plain.description.node_stride = 5;
    plain.description.connectivity = rows.data();
    plain.description.element_stride = 7;
    plain.description.index_base = 1;
    CHECK(applied(plain.create(), x) == want);
  }
  SUBCASE("copied arrays may go, and cost memory") {
    kacanov_information copied, borrowed;
    Vector coordinates = plain.mesh.coordinates;
    plain.description.coordinates = coordinates.data();
    const Handle op = plain.create();
    std::fill(coordinates.begin(), coordinates.end(), nan_value);
    CHECK(applied(op, x) == want);
    REQUIRE(kacanov_inspect(op.get(), &copied) == KACANOV_OK);

    plain.description.coordinates = plain.mesh.coordinates.data();
    plain.description.borrow = 1;
    const Handle lean = plain.create();
    CHECK(applied(lean, x) == want);
    REQUIRE(kacanov_inspect(lean.get(), &borrowed) == KACANOV_OK);
    CHECK(borrowed.bytes < copied.bytes);
  }
}

TEST_CASE("laws may come later and be replaced") {
  Example example;
  const Vector x = random_vector(example.n(), 4);
  const Vector want = applied(example.create(), x);

  example.description.laws = 0;
  const Handle op = example.create();
  Vector y(example.n());
  CHECK(kacanov_apply(op.get(), example.n(), x.data(), y.data()) == KACANOV_ERROR_STATE);
  CHECK(std::string(kacanov_message(op.get())).find("kacanov_set_laws") != std::string::npos);
  const std::size_t elements = example.mesh.elements();
  REQUIRE(kacanov_set_laws(op.get(), 2, example.laws.data(), elements, example.law_of_element.data()) ==
          KACANOV_OK);
  CHECK(applied(op, x) == want);

  SUBCASE("bad laws leave the handle as it was") {
    example.laws[1].shear = -1.0;
    CHECK(kacanov_set_laws(op.get(), 2, example.laws.data(), elements, nullptr) == KACANOV_ERROR_LAW);
    CHECK(std::string(kacanov_message(op.get())).find("law[1].shear") != std::string::npos);
    CHECK(kacanov_set_laws(op.get(), 1, example.laws.data(), elements + 1, nullptr) == KACANOV_ERROR_SIZE);
    CHECK(kacanov_set_laws(op.get(), 0, example.laws.data(), elements, nullptr) == KACANOV_ERROR_SIZE);
    CHECK(kacanov_set_laws(op.get(), 1, nullptr, elements, nullptr) == KACANOV_ERROR_NULL);
    CHECK(applied(op, x) == want);
  }
  SUBCASE("twice as stiff, twice the force") {
    for (kacanov_law& law : example.laws) {
      law.bulk *= 2.0;
      law.shear *= 2.0;
    }
    REQUIRE(kacanov_set_laws(op.get(), 2, example.laws.data(), elements, nullptr) == KACANOV_OK);
    Vector twice = want;
    for (double& v : twice) v *= 2.0;
    CHECK(distance(applied(op, x), twice) < 1e-12);
  }
}

TEST_CASE("several right sides are applied as if one at a time") {
  const Example example;
  const Handle op = example.create();
  const std::size_t n = example.n();
  for (const int vectors : {1, 2, 3, 5}) {
    const Vector x = random_vector(n * static_cast<std::size_t>(vectors), 8);
    Vector y(x.size()), want;
    REQUIRE(kacanov_apply_many(op.get(), n, vectors, x.data(), y.data()) == KACANOV_OK);
    for (auto from = x.begin(); from != x.end(); from += static_cast<std::ptrdiff_t>(n)) {
      const Vector one = applied(op, Vector(from, from + static_cast<std::ptrdiff_t>(n)));
      want.insert(want.end(), one.begin(), one.end());
    }
    CHECK(distance(y, want) < 1e-14);
  }
  const Vector x(n);
  Vector y(n);
  CHECK(kacanov_apply_many(op.get(), n, 0, x.data(), y.data()) == KACANOV_ERROR_VALUE);
}

TEST_CASE("single precision follows the double one") {
  for (const std::int32_t element : {KACANOV_TRI3, KACANOV_TET4, KACANOV_TET10, KACANOV_HEX8}) {
    CAPTURE(element);
    Example example(element);
    example.description.single = 1;
    const Handle op = example.create();
    const std::size_t n = example.n();
    const Vector x = random_vector(n, 9);
    const std::vector<float> x_float(x.begin(), x.end());
    std::vector<float> y_float(n);
    const auto check = [&] {
      REQUIRE(kacanov_apply_float(op.get(), n, x_float.data(), y_float.data()) == KACANOV_OK);
      const Vector want = applied(op, x);
      CHECK(distance(Vector(y_float.begin(), y_float.end()), want) < 1e-5);
    };
    check();
    const Vector omega = random_vector(n, 10, 0.1), doubled = random_vector(n, 11, 0.2);
    REQUIRE(kacanov_update(op.get(), n, omega.data()) == KACANOV_OK);
    check();
    REQUIRE(kacanov_update_tangent(op.get(), n, doubled.data()) == KACANOV_OK);
    check();
    double energy = 0.0, dot = 0.0, want_dot = 0.0;
    Vector y(n), diagonal(n);
    REQUIRE(kacanov_residual_energy_update(op.get(), n, omega.data(), y.data(), &energy) == KACANOV_OK);
    check();
    REQUIRE(kacanov_apply_dot(op.get(), n, x.data(), y.data(), &want_dot) == KACANOV_OK);
    REQUIRE(kacanov_apply_dot_float(op.get(), n, x_float.data(), y_float.data(), &dot) == KACANOV_OK);
    CHECK(dot == doctest::Approx(want_dot).epsilon(1e-5));
    REQUIRE(kacanov_diagonal(op.get(), n, diagonal.data()) == KACANOV_OK);
    REQUIRE(kacanov_diagonal_float(op.get(), n, y_float.data()) == KACANOV_OK);
    CHECK(distance(Vector(y_float.begin(), y_float.end()), diagonal) < 1e-5);
    std::vector<float> twice(x_float), both(2 * n);
    twice.insert(twice.end(), x_float.begin(), x_float.end());
    REQUIRE(kacanov_apply_many_float(op.get(), n, 2, twice.data(), both.data()) == KACANOV_OK);
    CHECK(std::equal(both.begin(), both.begin() + static_cast<std::ptrdiff_t>(n),
                     both.begin() + static_cast<std::ptrdiff_t>(n)));

    CHECK(kacanov_apply_float(op.get(), n, x_float.data(), nullptr) == KACANOV_ERROR_NULL);
    CHECK(kacanov_apply_float(op.get(), n + 1, x_float.data(), y_float.data()) == KACANOV_ERROR_SIZE);
    CHECK(kacanov_apply_float(op.get(), n, y_float.data(), y_float.data()) == KACANOV_ERROR_SIZE);
    const Handle plain = Example(element).create();
    CHECK(kacanov_apply_float(plain.get(), n, x_float.data(), y_float.data()) == KACANOV_ERROR_STATE);
  }
}

TEST_CASE("the preferred numbering names every node and element once") {
  const Example example(KACANOV_TET10, 3);
  const Handle op = example.create();
  const std::size_t nodes = example.mesh.nodes(), elements = example.mesh.elements();
  std::vector<std::int32_t> node_order(nodes, -1), element_order(elements, -1);
  REQUIRE(kacanov_locality_order(op.get(), nodes, node_order.data(), elements, nullptr) == KACANOV_OK);
  REQUIRE(kacanov_locality_order(op.get(), nodes, nullptr, elements, element_order.data()) == KACANOV_OK);
  for (std::vector<std::int32_t>* order : {&node_order, &element_order}) {
    std::sort(order->begin(), order->end());
    for (std::size_t i = 0; i < order->size(); ++i) CHECK((*order)[i] == static_cast<std::int32_t>(i));
  }
  CHECK(kacanov_locality_order(op.get(), nodes - 1, nullptr, elements, nullptr) == KACANOV_ERROR_SIZE);
}

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
      {[](Example& e) { e.laws[1].mean_dilatation = 1; }, KACANOV_ERROR_LAW, "law[1].mean_dilatation"},  // tet4
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
  CHECK(code({0, 1, 2}, {0, 2, 2}) == KACANOV_OK);
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
    example.mesh.coordinates[3 * 7 + c] = 0.2;  // far corner beyond the middle
  std::string text;
  CHECK(example.fault(text) == KACANOV_ERROR_MESH);
  CHECK(text.find("element 0 is inverted") != std::string::npos);
}

TEST_CASE("meshes of any size, place and direction are accepted, their mirror images are not") {
  for (const std::int32_t element : {KACANOV_TRI3, KACANOV_TET4, KACANOV_TET10, KACANOV_HEX8})
    for (const double size : {1e-6, 1.0, 1e6})
      for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
        CAPTURE(element);
        CAPTURE(size);
        CAPTURE(angle);
        Example example(element);
        const std::size_t dim = example.mesh.dim;
        for (std::size_t i = 0; i < example.n(); i += dim)
          for (std::size_t c = 0; c + 1 < dim; ++c) {  // turned about z, then about x
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
  kacanov_fields fields{};
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
  CHECK(std::string(kacanov_message(op.get())) == "omega[11] is not finite");
  CHECK(applied(op, x) == want);
}

TEST_CASE("null handles and short message buffers do no harm") {
  double value = 0.0;
  CHECK(kacanov_apply(nullptr, 0, &value, &value) == KACANOV_ERROR_NULL);
  CHECK(kacanov_set_laws(nullptr, 0, nullptr, 0, nullptr) == KACANOV_ERROR_NULL);
  CHECK(std::strlen(kacanov_message(nullptr)) > 0);
  kacanov_destroy(nullptr);
  CHECK(kacanov_elastic_law(1.0, 0.5, nullptr) == KACANOV_ERROR_NULL);
  kacanov_law law;
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

TEST_CASE("handles are independent: one in each thread of the caller") {
  const Example example;
  const Vector x = random_vector(example.n(), 6);
  const Vector want = applied(example.create(), x);
  std::vector<Vector> got(4, Vector(example.n()));
  std::vector<std::thread> threads;
  for (Vector& y : got)
    threads.emplace_back([&] {
      kacanov_operator* op = nullptr;
      if (kacanov_create(&example.description, &op, nullptr, 0) != KACANOV_OK) return;
      for (int repeat = 0; repeat < 50; ++repeat) kacanov_apply(op, example.n(), x.data(), y.data());
      kacanov_destroy(op);
    });
  for (std::thread& thread : threads) thread.join();
  for (const Vector& y : got) CHECK(y == want);
}
