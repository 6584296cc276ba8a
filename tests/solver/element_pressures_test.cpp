// SPDX-License-Identifier: BSD-3-Clause
// Element-wise pressures of hexahedra with averaged tr ε, and the multigrid cycle with them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../sanitized.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/multigrid.hpp"
#include "multigrid/pressure_rows.hpp"
#include "pressure_bodies.hpp"

using namespace kacanov;
using namespace kacanov::testing;

TEST_CASE("of elements that average over themselves A and the pressures of B u make the operator") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  // Of every three elements, one has another bulk modulus and one has no averaging.
  Model model = elastic_model();
  model.boundary.push_back(moved(named("left"), 3));
  model.materials[0].formulation = MaterialEntry::Formulation::mixed;
  model.materials.resize(3, model.materials[0]);
  model.materials[1].law.bulk *= 7.0;
  model.materials[2].formulation.reset();
  for (std::size_t k = 0; k < 3; ++k) model.materials[k].on = named("part" + std::to_string(k));
  Problem problem;
  if (rank == 0) {
    Mesh mesh = make_box({{2, 1, 1}, {7, 3, 5}, ElementType::hex8});
    for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
      mesh.coordinates[i] += 0.03 * std::sin(17.0 * static_cast<double>(i));
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.groups.push_back({"part" + std::to_string(k), 3, {}});
      for (std::size_t e = k; e < mesh.element_count(); e += 3)
        mesh.groups.back().members.push_back(static_cast<std::int32_t>(e));
    }
    problem = build_problem(mesh, model);
  }
  const Part part = distribute(rank == 0 ? &problem : nullptr, MPI_COMM_WORLD);
  const MultigridBody body = multigrid_body(part);
  PressureRows pressures(body);
  const Vector g = bent(part, 100.0);
  Operator op(part.body());
  op.set_secant(g);
  Vector x(part.unknowns()), y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = part.held[i] ? 0.0 : std::sin(0.7 * static_cast<double>(3 * part.node_index[i / 3] + i % 3));
  op.apply(x, y);
  part.node_map.sum(std::span<double>(y), 3);
  const double largest = part.node_map.max_all(std::abs(*std::max_element(y.begin(), y.end())));
  const std::vector<float> single(x.begin(), x.end());
  for (const int threads : {1, 2}) {
    CAPTURE(threads);
    MultigridOptions options;
    options.threads = threads;
    FineLevel fine(body, options, FinePart::deviator, &pressures.means());
    fine.setup(g, {{}, ConstrainedSpace()});
    std::vector<float> entries(pressures.means().size()), sum(x.size());
    fine.volume_change(single, entries);
    Vector p(pressures.rows());
    pressures.sum(entries, p);
    for (std::size_t r = 0; r < p.size(); ++r) p[r] /= pressures.compliance()[r];
    pressures.spread(p, entries);
    fine.multiply(single, entries, sum);
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (!part.held[i]) CHECK(std::abs(static_cast<double>(sum[i]) - y[i]) < 2e-6 * largest);
  }
}

TEST_CASE("counts hardly depend on k0/g where elements average over themselves" * doctest::skip(sanitized)) {
  const Part small = bar(8, false, ElementType::hex8), large = bar(16, false, ElementType::hex8);
  const Part graded = bar(12, true, ElementType::hex8);
  CHECK(iterations(small, 1000.0) <= 24);
  CHECK(iterations(large, 1000.0) <= 24);
  CHECK(iterations(large, 1e4) <= 35);
  CHECK(iterations(graded, 1000.0) <= 40);
  CHECK(iterations(graded, 1e4) <= 40);
  CHECK(iterations(small, 1000.0, 1e9) > 60);
}

TEST_CASE("elements longer than cubes keep the modes of aggregates" * doctest::skip(sanitized)) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (const bool long_ones : {false, true}) {
    CAPTURE(long_ones);
    Model model = elastic_model();
    model.materials[0].formulation = MaterialEntry::Formulation::mixed;
    model.boundary.push_back(moved(named("left"), 3));
    Problem problem;
    if (rank == 0)
      problem =
          build_problem(make_box({{long_ones ? 20.0 : 2.0, 1, 1}, {16, 8, 8}, ElementType::hex8}), model);
    const Part part = distribute(rank == 0 ? &problem : nullptr, MPI_COMM_WORLD);
    MultigridOptions options;
    Multigrid chosen(multigrid_body(part), options);
    options.element_contrast = 1e9;
    Multigrid modes(multigrid_body(part), options);
    const Vector g(part.body().secant_count(), 1e-3);
    for (Multigrid* one : {&chosen, &modes}) one->setup(g, {}, ConstrainedSpace());
    CHECK((chosen.bytes() == modes.bytes()) == long_ones);
  }
}
