// SPDX-License-Identifier: BSD-3-Clause
// The C interface: the same numbers as the reference, with every way of passing arrays.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstring>
#include <thread>

#include <kacanov/reference.hpp>
#include "c_example.hpp"

TEST_CASE("every element type gives the numbers of the reference") {
  for (const std::int32_t element :
       {KACANOV_TRI3, KACANOV_TET4, KACANOV_TET10, KACANOV_HEX8, KACANOV_QUAD4}) {
    CAPTURE(element);
    Example example(element);
    example.description.threads = 2;
    example.laws[0].mean_dilatation = element == KACANOV_HEX8 || element == KACANOV_QUAD4;
    const Handle op = example.create();
    const SmallMesh& mesh = example.mesh;
    const std::size_t n = example.n();

    std::vector<kacanov::Law> laws(2, kacanov::elastic_law(2.0, 0.3));
    laws[0].form = kacanov::laws::Logarithmic{0.02};
    laws[0].mean_dilatation = element == KACANOV_HEX8 || element == KACANOV_QUAD4;
    const kacanov::Body body{
        {static_cast<kacanov::ElementType>(element), mesh.coordinates, mesh.connectivity},
        laws,
        example.law_of_element};
    auto information = sized<kacanov_information>();
    REQUIRE(kacanov_inspect(op.get(), &information) == KACANOV_OK);
    CHECK(information.unknowns == n);
    CHECK(information.elements == mesh.elements());
    CHECK(information.threads == 1);  // too small for two
    CHECK(information.bytes > 0);
    CHECK(std::string(information.instruction_set) != "");
    const std::size_t points = mesh.elements() * static_cast<std::size_t>(information.points_per_element);
    REQUIRE(points == body.secant_count());

    const Vector u = random_vector(n, 1, 0.1), x = random_vector(n, 2);
    Vector g(points), want_g(points), y(n), want(n);
    REQUIRE(kacanov_update(op.get(), n, u.data()) == KACANOV_OK);
    REQUIRE(kacanov_secant(op.get(), points, g.data()) == KACANOV_OK);
    kacanov::reference::secant(body, u, want_g);
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

    REQUIRE(kacanov_update_tangent(op.get(), n, u.data()) == KACANOV_OK);
    REQUIRE(kacanov_apply_tangent(op.get(), n, x.data(), y.data()) == KACANOV_OK);
    kacanov::reference::apply_tangent(body, u, x, want);
    CHECK(distance(y, want) < 1e-6);  // the rank-one term is stored in single precision
    REQUIRE(kacanov_block_diagonal_tangent(op.get(), blocks.size(), blocks.data()) == KACANOV_OK);
    kacanov::reference::block_diagonal_tangent(body, u, want_blocks);
    CHECK(distance(blocks, want_blocks) < 1e-6);
    REQUIRE(kacanov_diagonal_tangent(op.get(), n, y.data()) == KACANOV_OK);
    for (std::size_t i = 0; i < n; ++i) CHECK(y[i] == blocks[i * mesh.dim + i % mesh.dim]);

    double energy = 0.0;
    REQUIRE(kacanov_residual(op.get(), n, u.data(), y.data()) == KACANOV_OK);
    REQUIRE(kacanov_energy(op.get(), n, u.data(), &energy) == KACANOV_OK);
    kacanov::reference::residual(body, u, want);
    CHECK(distance(y, want) < 1e-12);
    CHECK(energy == doctest::Approx(kacanov::reference::energy(body, u)));
    // Update at zero, then back to u in one pass.
    REQUIRE(kacanov_update(op.get(), n, Vector(n, 0.0).data()) == KACANOV_OK);
    double again = 0.0;
    REQUIRE(kacanov_residual_energy_update(op.get(), n, u.data(), y.data(), &again) == KACANOV_OK);
    CHECK(distance(y, want) < 1e-12);
    CHECK(again == doctest::Approx(energy));
    REQUIRE(kacanov_secant(op.get(), points, g.data()) == KACANOV_OK);
    CHECK(distance(g, want_g) < 1e-12);

    const std::size_t elements = mesh.elements();
    Vector stress(6 * elements), mises(elements), strain(elements), mean_g(elements);
    Vector want_stress(stress.size()), want_mises(elements), want_strain(elements), want_mean_g(elements);
    std::vector<std::uint8_t> plastic(elements), want_plastic(elements);
    auto fields = sized<kacanov_fields>();
    fields.elements = elements;
    fields.stress = stress.data();
    fields.von_mises = mises.data();
    fields.dev_strain = strain.data();
    fields.secant = mean_g.data();
    fields.plastic = plastic.data();
    REQUIRE(kacanov_stress(op.get(), n, u.data(), &fields) == KACANOV_OK);
    kacanov::reference::fields(body, u,
                               {.stress = want_stress,
                                .von_mises = want_mises,
                                .dev_strain = want_strain,
                                .secant = want_mean_g,
                                .plastic = want_plastic});
    CHECK(distance(stress, want_stress) < 1e-12);
    CHECK(distance(mises, want_mises) < 1e-12);
    CHECK(distance(strain, want_strain) < 1e-12);
    CHECK(distance(mean_g, want_mean_g) < 1e-12);
    CHECK(plastic == want_plastic);
  }
}

TEST_CASE("every law arrives with its parameters") {
  const Vector table_x{0.0, 0.02, 0.05, 0.2}, table_s{0.0, 0.03, 0.06, 0.1};
  for (const std::int32_t kind : {KACANOV_LINEAR, KACANOV_LOGARITHMIC, KACANOV_LINEAR_HARDENING,
                                  KACANOV_POWER, KACANOV_SATURATING, KACANOV_TABLE})
    for (const bool squared : {false, true}) {
      CAPTURE(kind);
      CAPTURE(squared);
      Example example;
      kacanov_law& law = example.laws[0];
      law.kind = kind;
      law.squared = squared;
      law.x0 = squared ? 0.0004 : 0.02;
      law.gamma = 0.1;
      law.n = 0.4;
      law.q = 0.7;
      law.table_size = table_x.size();
      law.table_x = table_x.data();
      law.table_s = table_s.data();
      kacanov::Law want = kacanov::elastic_law(2.0, 0.3);
      want.argument = squared ? kacanov::Law::Argument::squared : kacanov::Law::Argument::norm;
      using namespace kacanov;
      const Law::Form forms[] = {laws::Linear{},
                                 laws::Logarithmic{law.x0},
                                 laws::LinearHardening{law.x0, law.gamma},
                                 laws::Power{law.x0, law.n},
                                 laws::Saturating{law.x0, law.q},
                                 laws::Table{table_x, table_s}};
      want.form = forms[kind];

      const Handle op = example.create();
      const Vector u = random_vector(example.n(), 12, 0.1);
      const std::size_t elements = example.mesh.elements();
      Vector strain(elements), g(elements);
      auto fields = sized<kacanov_fields>();
      fields.elements = elements;
      fields.dev_strain = strain.data();
      REQUIRE(kacanov_stress(op.get(), example.n(), u.data(), &fields) == KACANOV_OK);
      REQUIRE(kacanov_update(op.get(), example.n(), u.data()) == KACANOV_OK);
      REQUIRE(kacanov_secant(op.get(), elements, g.data()) == KACANOV_OK);
      for (std::size_t e = 0; e < elements; e += 2)  // odd elements follow the linear law
        CHECK(g[e] == doctest::Approx(want.secant(strain[e])).epsilon(1e-12));
    }
}

#if defined(__x86_64__)
// Sizes that bindings in other languages rely on, for example examples/ctypes_numpy.py.
static_assert(sizeof(kacanov_law) == 120);
static_assert(sizeof(kacanov_description) == 168);
#endif

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
    const Handle op = plain.create();
    std::fill(rows.begin(), rows.end(), -5);  // the handle must not refer to them any more
    CHECK(applied(op, x) == want);
  }
  SUBCASE("copied arrays may go, and cost memory") {
    auto copied = sized<kacanov_information>(), borrowed = copied;
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
  for (const std::int32_t element :
       {KACANOV_TRI3, KACANOV_TET4, KACANOV_TET10, KACANOV_HEX8, KACANOV_QUAD4}) {
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
    const Vector u = random_vector(n, 10, 0.1), doubled = random_vector(n, 11, 0.2);
    REQUIRE(kacanov_update(op.get(), n, u.data()) == KACANOV_OK);
    check();
    REQUIRE(kacanov_update_tangent(op.get(), n, doubled.data()) == KACANOV_OK);
    check();
    double energy = 0.0, dot = 0.0, want_dot = 0.0;
    Vector y(n), diagonal(n);
    REQUIRE(kacanov_residual_energy_update(op.get(), n, u.data(), y.data(), &energy) == KACANOV_OK);
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

namespace {

/// The example's body, shifted to start at r = 0.5, and its reference.
struct PlaneExample : Example {
  std::vector<kacanov::Law> reference_laws{2, kacanov::elastic_law(2.0, 0.3)};

  PlaneExample(std::int32_t element, std::int32_t plane, std::size_t n = 3) : Example(element, n) {
    for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2) mesh.coordinates[i] += 0.5;
    description.plane = plane;
    reference_laws[0].form = kacanov::laws::Logarithmic{0.02};
    if (element == KACANOV_QUAD4 && plane == KACANOV_AXISYMMETRIC) {
      laws[0].mean_dilatation = 1;
      reference_laws[0].mean_dilatation = true;
    }
  }
  kacanov::Body body() const {
    return {{static_cast<kacanov::ElementType>(description.element), mesh.coordinates, mesh.connectivity,
             description.plane == KACANOV_PLANE_STRESS ? kacanov::PlaneState::stress
                                                       : kacanov::PlaneState::axisymmetric},
            reference_laws,
            law_of_element};
  }
};

}  // namespace

TEST_CASE("plane stress and bodies of revolution give the numbers of the reference") {
  for (const std::int32_t element : {KACANOV_TRI3, KACANOV_QUAD4})
    for (const std::int32_t plane : {KACANOV_PLANE_STRESS, KACANOV_AXISYMMETRIC}) {
      CAPTURE(element);
      CAPTURE(plane);
      const PlaneExample example(element, plane);
      const Handle op = example.create();
      const kacanov::Body body = example.body();
      const std::size_t n = example.n(), elements = example.mesh.elements();
      const Vector u = random_vector(n, 1, 0.1), x = random_vector(n, 2);
      Vector y(n), want(n), g(body.secant_count());
      REQUIRE(kacanov_update(op.get(), n, u.data()) == KACANOV_OK);
      kacanov::reference::secant(body, u, g);
      kacanov::reference::apply(body, g, x, want);
      CHECK(distance(applied(op, x), want) < 1e-12);
      REQUIRE(kacanov_residual(op.get(), n, u.data(), y.data()) == KACANOV_OK);
      kacanov::reference::residual(body, u, want);
      CHECK(distance(y, want) < 1e-12);
      double energy = 0.0;
      REQUIRE(kacanov_energy(op.get(), n, u.data(), &energy) == KACANOV_OK);
      CHECK(energy == doctest::Approx(kacanov::reference::energy(body, u)));
      REQUIRE(kacanov_update_tangent(op.get(), n, u.data()) == KACANOV_OK);
      REQUIRE(kacanov_apply_tangent(op.get(), n, x.data(), y.data()) == KACANOV_OK);
      kacanov::reference::apply_tangent(body, u, x, want);
      CHECK(distance(y, want) < 1e-6);
      Vector stress(6 * elements), want_stress(6 * elements);
      auto fields = sized<kacanov_fields>();
      fields.elements = elements;
      fields.stress = stress.data();
      REQUIRE(kacanov_stress(op.get(), n, u.data(), &fields) == KACANOV_OK);
      kacanov::reference::ElementFields wanted;
      wanted.stress = want_stress;
      kacanov::reference::fields(body, u, wanted);
      CHECK(distance(stress, want_stress) < 1e-12);
      std::size_t entries = 0;
      REQUIRE(kacanov_matrix_entries(op.get(), n, &entries) == KACANOV_OK);
      std::vector<std::int64_t> first(n + 1);
      std::vector<std::int32_t> column(entries);
      Vector value(entries), product(n, 0.0);
      REQUIRE(kacanov_matrix(op.get(), n, nullptr, entries, first.data(), column.data(), value.data()) ==
              KACANOV_OK);
      for (std::size_t i = 0; i < n; ++i)
        for (std::int64_t k = first[i]; k < first[i + 1]; ++k) product[i] += value[k] * x[column[k]];
      CHECK(distance(product, applied(op, x)) < 1e-12);
    }
}

TEST_CASE("multigrid and conjugate gradients solve plane stress and bodies of revolution") {
  for (const std::int32_t plane : {KACANOV_PLANE_STRESS, KACANOV_AXISYMMETRIC}) {
    const PlaneExample example(KACANOV_QUAD4, plane, 24);
    const Handle op = example.create();
    hold(op, example.mesh);
    const std::size_t n = example.n();
    const MultigridHandle multigrid = multigrid_of(op);
    const Vector want = [&] {
      Vector x = random_vector(n, 5);
      for (const std::int32_t i : bottom(example.mesh)) x[i] = 0.0;
      return x;
    }();
    const Vector b = applied(op, want);
    Vector x(n, 0.0);
    auto options = sized<kacanov_cg_options>();
    options.relative = 1e-10;
    auto result = sized<kacanov_cg_result>();
    REQUIRE(kacanov_cg(op.get(), multigrid.get(), &options, n, b.data(), x.data(), &result) == KACANOV_OK);
    CHECK(result.converged == 1);
    CHECK(result.iterations < 60);
    CHECK(distance(x, want) < 1e-7);
  }
}

TEST_CASE("an older client's body is in plane strain; what no plane is for is refused by name") {
  PlaneExample example(KACANOV_QUAD4, KACANOV_PLANE_STRESS);
  const Vector x = random_vector(example.n(), 2);
  example.description.plane = KACANOV_PLANE_STRAIN;
  const Vector strain = applied(example.create(), x);
  example.description.plane = KACANOV_PLANE_STRESS;
  CHECK(distance(applied(example.create(), x), strain) > 0.01);
  example.description.struct_size = offsetof(kacanov_description, plane);
  CHECK(applied(example.create(), x) == strain);
  example.description.struct_size = sizeof example.description;

  const auto refused = [](const Example& wrong, int code, const char* word) {
    std::string text;
    CHECK(wrong.fault(text) == code);
    CHECK_MESSAGE(text.find(word) != std::string::npos, text);
  };
  example.laws[0].mean_dilatation = 1;
  refused(example, KACANOV_ERROR_LAW, "law[0].mean_dilatation: is not for plane stress");
  example.laws[0].mean_dilatation = 0;
  example.description.plane = 3;
  refused(example, KACANOV_ERROR_VALUE, "plane: expected a kacanov_plane, got 3");
  example.description.plane = KACANOV_AXISYMMETRIC;
  example.description.reserved_plane = 1;
  refused(example, KACANOV_ERROR_VALUE, "reserved_plane");
  example.description.reserved_plane = 0;
  example.mesh.coordinates[0] = -1.0;
  refused(example, KACANOV_ERROR_MESH, "radius below 0");
  example.mesh.coordinates[0] = 0.5;
  example.laws[1].kind = KACANOV_USER;
  example.laws[1].evaluate = [](void*, const kacanov_law_points*) { return 0; };
  refused(example, KACANOV_ERROR_LAW,
          "law[1].evaluate: laws of the caller's own are for plane strain and 3D");
  Example solid(KACANOV_TET4);
  solid.description.plane = KACANOV_PLANE_STRESS;
  refused(solid, KACANOV_ERROR_MESH, "plane: expected plane strain, as the mesh is not flat");
}

namespace {

/// A struct of this header as a newer client declares it, with `more` appended.
template <class Struct>
struct Longer {
  Struct known{};
  std::int64_t more = 0;
  Longer() { known.struct_size = sizeof *this; }
};

int created(const void* description, std::string& text) {
  kacanov_operator* op = nullptr;
  char message[256];
  const int code =
      kacanov_create(static_cast<const kacanov_description*>(description), &op, message, sizeof message);
  kacanov_destroy(op);
  text = message;
  return code;
}

}  // namespace

TEST_CASE("what a newer client's struct has beyond this library has to be zero") {
  const Example example;
  std::string text;
  Longer<kacanov_description> body;
  body.known = example.description;
  body.known.struct_size = sizeof body;
  CHECK(created(&body, text) == KACANOV_OK);
  body.more = 1;
  CHECK(created(&body, text) == KACANOV_ERROR_VALUE);
  CHECK(text.find("kacanov_description") != std::string::npos);

  body.more = 0;
  std::vector<Longer<kacanov_law>> laws(2);
  for (Longer<kacanov_law>& law : laws) {
    law.known = logarithmic();
    law.known.struct_size = sizeof law;
  }
  body.known.law = &laws[0].known;
  CHECK(created(&body, text) == KACANOV_OK);
  laws[1].more = 1;
  CHECK(created(&body, text) == KACANOV_ERROR_VALUE);
  CHECK(text.find("law[1].") != std::string::npos);
  laws[1].more = 0;
  laws[1].known.struct_size = sizeof(kacanov_law);
  CHECK(created(&body, text) == KACANOV_ERROR_SIZE);
  CHECK(text.find("law[1].struct_size") != std::string::npos);
}

TEST_CASE("what the library writes fits the client's struct, and the rest of it is zero") {
  const Example example;
  const Handle op = example.create();
  Longer<kacanov_information> about;
  about.more = -1;
  REQUIRE(kacanov_inspect(op.get(), &about.known) == KACANOV_OK);
  CHECK(about.known.struct_size == sizeof about);
  CHECK(about.known.unknowns == example.n());
  CHECK(about.more == 0);
}

TEST_CASE("a struct without its size is refused by name") {
  Example example;
  std::string text;
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{8}, offsetof(kacanov_description, orphans), std::size_t{1} << 40}) {
    example.description.struct_size = size;
    CHECK(created(&example.description, text) == KACANOV_ERROR_SIZE);
    CHECK(text.find("struct_size") != std::string::npos);
  }
  kacanov_law law{};
  CHECK(kacanov_elastic_law(1.0, 0.3, &law) == KACANOV_ERROR_SIZE);
  const Example right;
  const Handle op = right.create();
  kacanov_information about{};
  CHECK(kacanov_inspect(op.get(), &about) == KACANOV_ERROR_SIZE);
  CHECK(std::string(kacanov_message(op.get())).find("information.struct_size") != std::string::npos);
  kacanov_fields fields{};
  const Vector u(right.n(), 0.0);
  CHECK(kacanov_stress(op.get(), u.size(), u.data(), &fields) == KACANOV_ERROR_SIZE);
}

TEST_CASE("every code has words of its own, and the header its library's version") {
  std::vector<std::string> words;
  for (int code = KACANOV_OK; code <= KACANOV_ERROR_CASE; ++code) words.emplace_back(kacanov_code_text(code));
  words.emplace_back(kacanov_code_text(-1));
  CHECK(words.back() == kacanov_code_text(1000));
  for (std::size_t i = 0; i < words.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK(words[i] != words[j]);
  CHECK(std::string(kacanov_version()) == KACANOV_PROJECT_VERSION);
}
