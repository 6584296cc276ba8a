// SPDX-License-Identifier: BSD-3-Clause
// Aggregation levels whose coarse matrix BoomerAMG solves: the distributed matrix, contraction, use within
// CG.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "amg/make_preconditioner.hpp"
#include "chain.hpp"
#include "linear/distributed_operator.hpp"
#include "multigrid/aggregation/coarse_space.hpp"
#include "multigrid/cg.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

Part block(ElementType type) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const int cells = dimension(type) == 2 ? 50 : 13;
  Model model = elastic_model();
  model.boundary.push_back(moved(named("left"), dimension(type)));
  if (rank > 0) return distribute(nullptr, MPI_COMM_WORLD);
  const Problem problem = build_problem(make_box({{1, 1, 1}, {cells, cells, cells}, type}), model);
  return distribute(&problem, MPI_COMM_WORLD);
}

/// Small aggregates, so that even a small body has a coarse matrix too large to factorise. `handed_over`
/// counts the matrices given to BoomerAMG; null: BoomerAMG is not used.
MultigridOptions aggregates(int* handed_over) {
  MultigridOptions options;
  options.fine_size = 4.0;
  options.grid_contrast = 0.0;
  if (handed_over == nullptr) return options;
  options.coarse_rows = std::numeric_limits<int>::max();
  options.make_coarse = [handed_over](const CoarseMatrix& matrix) {
    ++*handed_over;
    return make_coarse_amg(matrix);
  };
  return options;
}

Vector waves(const Part& part, double frequency) {
  Vector x(part.unknowns());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] =
        std::sin(frequency * static_cast<double>(part.node_index[i / static_cast<std::size_t>(part.dim())]) +
                 static_cast<double>(i % static_cast<std::size_t>(part.dim())));
  return x;
}

int iterations(const Part& part, const Space& space, const Vector& g, PartMultigrid& multigrid) {
  DistributedOperator op(part, 1, "");
  op.set_secant(g);
  CgWork work;
  work.resize(part.unknowns());
  work.residual = waves(part, 0.3);
  space.project(work.residual);
  Vector u(part.unknowns(), 0.0);
  const CgResult solve = conjugate_gradients(
      space, [&](std::span<const double> p, std::span<double> q) { return op.apply(p, q); },
      [&](std::span<const double> p, std::span<double> q) { multigrid.apply(p, q); }, u, work,
      {0.0, 1e-8, 400});
  CHECK(solve.converged);
  return solve.iterations;
}

}  // namespace

TEST_CASE("a level's matrix is handed over whole") {
  BlockMatrix<6> level = chain(9);
  const CoarseMatrix matrix = coarse_matrix(level, 0.8);
  CHECK(matrix.motions == 6);
  CHECK(matrix.length == 0.8);
  Vector x = wave(level, 0.7), y(level.owned_size());
  level.multiply(x, y);  // fills the ghosts of x
  Vector sum(y.size(), 0.0);
  for (std::size_t k = 0; k < matrix.row.size(); ++k)
    for (std::size_t m = 0; m < 6; ++m)
      for (std::size_t n = 0; n < 6; ++n)
        sum[static_cast<std::size_t>(level.local(matrix.row[k])) * 6 + m] +=
            matrix.block[(k * 6 + m) * 6 + n] *
            x[static_cast<std::size_t>(level.local(matrix.column[k])) * 6 + n];
  REQUIRE(matrix.centres.size() * 6 == y.size());
  for (std::size_t i = 0; i < y.size(); ++i) CHECK(sum[i] == doctest::Approx(y[i]).epsilon(1e-12));
}

TEST_CASE("BoomerAMG on a level is symmetric, definite and a contraction") {
  BlockMatrix<6> level = chain(300);
  const auto amg = make_coarse_amg(coarse_matrix(level, 1.0));
  const std::size_t size = level.owned_size();
  Vector e = wave(level, 0.7), f = wave(level, 0.11), ae(size), af(size), x(level.size()), z(size), ax(size);
  level.multiply(e, ae);
  level.multiply(f, af);
  amg->solve(ae, std::span(x).first(size));
  amg->solve(af, z);
  CHECK(dot(z, ae, size) == doctest::Approx(dot(x, af, size)).epsilon(1e-10).scale(dot(e, ae, size)));
  CHECK(dot(x, ae, size) > 0.0);
  for (std::size_t i = 0; i < size; ++i) x[i] = e[i] - x[i];
  level.multiply(x, ax);
  CHECK(dot(x, ax, size) < 0.3 * dot(e, ae, size));
}

TEST_CASE("a cycle with BoomerAMG below the aggregates is symmetric, definite and serves CG") {
  for (const ElementType type : {ElementType::hex8, ElementType::tri3}) {
    CAPTURE(static_cast<int>(type));
    const Part part = block(type);
    const Space free(part);
    Vector g(part.body().secant_count());
    for (std::size_t i = 0; i < g.size(); ++i) g[i] = i % 7 == 0 ? 0.02 : 0.4;
    int count = 0;
    PartMultigrid own(part, aggregates(nullptr)), handed(part, aggregates(&count));
    own.setup(g, {}, free);
    handed.setup(g, {}, free);
    CHECK(count == 1);
    Vector x = waves(part, 0.7), y = waves(part, 1.9), mx(x.size()), my(x.size());
    free.project(x);
    free.project(y);
    handed.apply(x, mx);
    handed.apply(y, my);
    CHECK(std::abs(free.dot(mx, y) - free.dot(x, my)) <= 1e-5 * std::sqrt(free.dot(mx, x) * free.dot(my, y)));
    CHECK(free.dot(mx, x) > 0.0);
    Vector copy = mx;
    part.node_map.forward(copy, part.dim());
    CHECK(copy == mx);
    CHECK(iterations(part, free, g, handed) <= 2 * iterations(part, free, g, own));

    // Constraints added later: the hierarchy is set up again.
    Space held(part);
    for (std::size_t n = 0; n < part.nodes(); ++n)
      if (part.node_index[n] % 9 == 0) held.hold(static_cast<std::int32_t>(n), Vector3{0.6, 0.8, 0.0});
    own.setup(g, {}, held);
    handed.setup(g, {}, held);
    CHECK(count == 2);
    CHECK(iterations(part, held, g, handed) <= 2 * iterations(part, held, g, own));
  }
}
