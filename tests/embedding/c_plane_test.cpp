// SPDX-License-Identifier: BSD-3-Clause
// Plane stress and axisymmetry in the C interface.
#include <cstddef>

#include <kacanov/reference.hpp>
#include "multigrid_example.hpp"

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
