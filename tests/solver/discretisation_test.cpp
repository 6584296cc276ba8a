// SPDX-License-Identifier: BSD-3-Clause
// The discretisation error estimate: zero where the element is exact, otherwise the true error, on any number
// of ranks.
#include <kacanov/discretisation.hpp>

#include <doctest/doctest.h>

#include "recovery/error_quadrature.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A block fixed at its left end with its right end displaced downwards, so that the energy is the strain
/// energy alone.
Model bent_model(int dim, const Law& law) {
  Model model;
  model.materials.push_back({everything(), law});
  model.boundary.push_back(moved(named("left"), dim));
  Vector3 down{};
  down[static_cast<std::size_t>(dim) - 1] = -0.02;
  model.boundary.push_back(moved(named("right"), dim, down));
  model.solver.tolerance = 1e-8;
  return model;
}

}  // namespace

TEST_CASE("the finer rules integrate what they should") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const Cell& shape = cell(type);
    const int degree = 2 * shape.order;
    // ∫ x^p over the reference cell: p! dim!/(p + dim)! of a simplex's volume; by axes for a cube.
    for (int p = 0; p <= degree; ++p) {
      double sum = 0.0, expected = 1.0;
      for (const QuadraturePoint& point : error_quadrature(shape)) {
        CHECK(point.weight > 0.0);
        sum += point.weight * std::pow(point.xi[0], p);
      }
      if (shape.simplex)
        for (int i = 1; i <= shape.dim; ++i) expected /= p + i;
      else
        expected = (p % 2 == 0 ? 2.0 / (p + 1) : 0.0) * (shape.dim == 3 ? 4.0 : 2.0);
      CHECK(sum == doctest::Approx(expected).epsilon(1e-12).scale(1.0));
    }
  }
}

TEST_CASE("no error is seen where strains are even") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const int dim = dimension(type);
    Model model = bent_model(dim, elastic_law(1.0, 0.3));
    const Problem problem = build_problem(box_mesh(type), model);
    const Part part = over_all_ranks(problem);
    const DiscretisationError error =
        estimate_error(part, nodal_field(part, [](const Vector3& x) {
                         return Vector3{0.3 * x[0] + 0.1 * x[1], -0.2 * x[1], 0.1 * x[2]};
                       }));
    CHECK(error.stored > 0.0);
    CHECK(error.relative < 1e-7);
  }
}

TEST_CASE("linear strains of straight elements: their known distance from even ones") {
  // u = (0, x²/2) has the strain ε_xy = x/2; its interpolant's strain is known on each element: (x_left +
  // h/2)/2 on quad4 and hex8 of width h, so that ∫ 4 μ (ε − ε_h)² is μ h²/12 per unit of volume.
  for (const ElementType type : {ElementType::quad4, ElementType::hex8}) {
    CAPTURE(cell(type).name);
    const int cells = 8;
    const int dim = dimension(type);
    const Problem problem =
        build_problem(make_box({{1.0, 1.0, 1.0}, {cells, cells, dim == 3 ? cells : 1}, type}),
                      bent_model(dim, elastic_law(1.0, 0.0)));
    const Part part = over_all_ranks(problem);
    const DiscretisationError error = estimate_error(part, nodal_field(part, [](const Vector3& x) {
                                                       return Vector3{0.0, 0.5 * x[0] * x[0], 0.0};
                                                     }));
    const double h = 1.0 / cells, mu = 0.5;
    CHECK(error.energy == doctest::Approx(0.5 * mu * h * h / 12.0).epsilon(0.02));
  }
}

TEST_CASE("any number of ranks estimates the same") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const int dim = dimension(type);
    Model model = bent_model(dim, logarithmic_law(0.002));
    model.materials.push_back({box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), elastic_law(3.0, 0.2)});
    const Problem problem = build_problem(box_mesh(type), model);
    const auto field = [](const Vector3& x) {
      return Vector3{0.01 * x[0] * x[1], std::sin(x[0]) * 0.02, 0.01 * x[2] * x[0]};
    };
    const Part all = over_all_ranks(problem), alone = distribute(&problem, MPI_COMM_SELF);
    const DiscretisationError many = estimate_error(all, nodal_field(all, field));
    const DiscretisationError one = estimate_error(alone, nodal_field(alone, field));
    CHECK(many.energy == doctest::Approx(one.energy).epsilon(1e-9));
    CHECK(many.stored == doctest::Approx(one.stored).epsilon(1e-12));
    for (std::size_t e = 0; e < all.element_count(); ++e)
      CHECK(many.element[e] == doctest::Approx(one.element[all.element_index[e]]).epsilon(1e-6));
  }
}

TEST_CASE("errors of numbers from meshes of falling width") {
  CHECK(!error_of_last(std::vector<double>{1.0}).has_value());
  CHECK(*error_of_last(std::vector<double>{1.0, 1.0}) == 0.0);
  // 2 + 3 h²: the error is a third of the last difference; three values determine the order.
  CHECK(*error_of_last(std::vector<double>{5.0, 2.75}) == doctest::Approx(0.75));
  CHECK(*error_of_last(std::vector<double>{5.0, 2.75, 2.1875}) == doctest::Approx(0.1875));
  // 2 + 3 h: first order.
  CHECK(*error_of_last(std::vector<double>{5.0, 3.5, 2.75}) == doctest::Approx(0.75));
  // Differences that do not decrease give no extrapolation; the last difference is the estimate.
  CHECK(*error_of_last(std::vector<double>{1.0, 1.1, 1.3}) == doctest::Approx(0.2));
}
