// SPDX-License-Identifier: BSD-3-Clause
// Aggregates, distributed Galerkin levels, and the purpose of the cycle: few iterations on any mesh.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include <kacanov/operator.hpp>
#include "../sanitized.hpp"
#include "amg/make_preconditioner.hpp"
#include "chain.hpp"
#include "multigrid/aggregation/aggregates.hpp"
#include "multigrid/aggregation/block_matrix.hpp"
#include "multigrid/aggregation/coarse_space.hpp"
#include "multigrid/cg.hpp"
#include "multigrid/fine_level.hpp"
#include "preconditioners.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Returns the CG iterations to 1e-8 with every seventh element `stretch` times as stiff in shear as the
/// others.
int iterations(const Part& part, double stretch, const char* preconditioner = "multigrid") {
  const Space space(part);
  Operator op(part.body());
  Vector g(part.body().secant_count());
  op.secant(g);
  for (std::size_t e = 0; e < g.size(); ++e) g[e] *= e % 7 == 0 ? stretch : 1.0;
  op.set_secant(g);
  const auto amg = preconditioner_named(preconditioner, part);
  amg->setup(g, {}, space);
  CgWork work;
  work.resize(part.unknowns());
  for (std::size_t i = 0; i < part.unknowns(); ++i)
    work.residual[i] =
        std::sin(static_cast<double>(part.node_index[i / static_cast<std::size_t>(part.dim())]) +
                 static_cast<double>(i % static_cast<std::size_t>(part.dim())));
  Vector u(part.unknowns(), 0.0);
  const CgResult solve = conjugate_gradients(
      space,
      [&](std::span<const double> p, std::span<double> q) {
        const double share = op.apply_dot(p, q);
        part.node_map.sum(q, part.dim());
        return share;
      },
      [&](std::span<const double> p, std::span<double> q) { amg->apply(p, q); }, u, work, {0.0, 1e-8, 400});
  CHECK(solve.converged);
  return solve.iterations;
}

Part long_beam(int cells, double length, ElementType type) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Model model = elastic_model();
  model.boundary.push_back(moved(named("left"), dimension(type)));
  if (rank > 0) return distribute(nullptr, MPI_COMM_WORLD);
  const Problem problem = build_problem(make_box({{length, 1, 1}, {3 * cells, cells, cells}, type}), model);
  return distribute(&problem, MPI_COMM_WORLD);
}

}  // namespace

namespace {

/// Checks that xᵀ A y on the aggregates equals (Z x)ᵀ (B + blocks) (Z y) on the nodes for random x and y,
/// where Z prolongs rigid-body motions into the constrained space.
template <int M>
void check_galerkin(const Part& part, std::span<const double> g, std::span<const NodeBlock> blocks,
                    const Space& space, const AggregateMotions<M>& motions, BlockMatrix<M>& level) {
  const std::size_t dim = part.dim();
  const auto random = [&](double seed) {
    Vector x(level.size());
    for (std::size_t i = 0; i < level.owned_size(); ++i)
      x[i] = std::sin(seed * static_cast<double>(level.first() * M + static_cast<std::int64_t>(i) + 1));
    return x;
  };
  const auto on_nodes = [&](const Vector& x) {
    std::vector<float> single(part.unknowns());
    motions.prolong(x, 1.0, single);
    part.node_map.forward(std::span<float>(single), part.dim());
    Vector u(single.begin(), single.end());
    space.project(u);
    return u;
  };
  Vector x = random(12.9898), y = random(78.233), image(level.size());
  const Vector u = on_nodes(x), v = on_nodes(y);
  level.multiply(y, image);
  Vector force(part.unknowns());
  reference::apply(part.body(), g, v, force);
  double expected = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    expected += u[i] * force[i];
    scale += std::abs(u[i] * force[i]);
  }
  for (const NodeBlock& block : blocks)
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j)
        expected += u[static_cast<std::size_t>(block.node) * dim + i] * block.value[i * dim + j] *
                    v[static_cast<std::size_t>(block.node) * dim + j];
  CHECK(std::abs(dot(x, image, level.owned_size()) - sum_all(expected)) < 1e-5 * sum_all(scale));
}

}  // namespace

TEST_CASE("the first coarse matrix is Galerkin's, summed once or again") {
  std::string set;  // the best available set
  SUBCASE("by the best loop") {}
  SUBCASE("by the plain loop") { set = "plain"; }
  for (const ElementType type : element_types()) {
    CAPTURE(static_cast<int>(type));
    const Part part = long_beam(dimension(type) == 2 ? 12 : 4, 3.0, type);
    const std::size_t dim = part.dim();
    Vector g(part.body().secant_count(), 1.0);
    const auto check = [&]<int M>(std::integral_constant<int, M>) {
      AggregateMotions<M> motions(multigrid_body(part), g, {.instruction_set = set, .fine_size = 8.0});
      BlockMatrix<M> level = motions.make_level();
      const Space free(part);
      motions.setup(g, {{}, free.held()}, level);
      check_galerkin<M>(part, g, {}, free, motions, level);
      // Other moduli, a constrained direction at some nodes, and penalty blocks.
      for (std::size_t e = 0; e < g.size(); ++e) g[e] = 0.2 + static_cast<double>(e % 5);
      std::vector<NodeBlock> blocks;
      Space space(part);
      for (std::size_t n = 0; n < part.nodes(); ++n) {
        if (part.node_index[n] % 7 == 0) space.hold(static_cast<std::int32_t>(n), Vector3{0.6, 0.8, 0.0});
        if (part.node_index[n] % 5 != 0 || n >= static_cast<std::size_t>(part.owned_nodes())) continue;
        NodeBlock block{static_cast<std::int32_t>(n), {}};
        for (std::size_t c = 0; c < dim; ++c) block.value[c * dim + c] = 1.0 + static_cast<double>(c);
        blocks.push_back(block);
      }
      motions.setup(g, {blocks, space.held()}, level);
      check_galerkin<M>(part, g, blocks, space, motions, level);
      // Release some constraints and add others: the update gives the same matrix as a new sum.
      Space later(part);
      for (std::size_t n = 0; n < part.nodes(); ++n) {
        if (part.node_index[n] % 14 == 0) later.hold(static_cast<std::int32_t>(n), Vector3{0.6, 0.8, 0.0});
        if (part.node_index[n] % 11 == 3) later.hold(static_cast<std::int32_t>(n), Vector3{0.0, 1.0, 0.0});
        if (part.node_index[n] % 21 == 0 && part.node_index[n] % 14 != 0)
          later.hold(static_cast<std::int32_t>(n), Vector3{0.8, -0.6, 0.0});
      }
      const std::vector<NodeBlock> fewer(blocks.begin(),
                                         blocks.begin() + static_cast<std::ptrdiff_t>(blocks.size() / 2));
      motions.update(g, {blocks, space.held()}, {fewer, later.held()}, level);
      auto x = wave(level, 0.7);
      Vector changed(level.owned_size()), summed(changed);
      level.multiply(x, changed);
      motions.setup(g, {fewer, later.held()}, level);
      level.multiply(x, summed);
      for (std::size_t i = 0; i < summed.size(); ++i)
        CHECK(changed[i] == doctest::Approx(summed[i]).epsilon(1e-10).scale(10.0));
    };
    if (dim == 3)
      check(std::integral_constant<int, 6>{});
    else
      check(std::integral_constant<int, 3>{});
  }
}

TEST_CASE("aggregates follow the strong couplings and leave nobody out") {
  // Cells ten times longer than wide: aggregates lie in the cross-sections.
  const Mesh mesh = make_box({{30, 1, 1}, {30, 10, 10}, ElementType::tet4});
  const std::vector<Law> laws{Law{}};
  const std::vector<std::uint16_t> law(mesh.element_count(), 0);
  const std::vector<double> g(mesh.element_count(), 1.0);
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  std::int32_t section = nodes;
  SUBCASE("all at once") {}
  SUBCASE("in sections of the numbering") { section = 1000; }
  const auto group = aggregate_nodes({mesh.view(), laws, law}, g, nodes, {12.0, section});
  REQUIRE(group.size() == mesh.node_count());
  const std::int32_t groups = 1 + *std::max_element(group.begin(), group.end());
  std::vector<int> members(groups, 0);
  std::vector<double> low(members.size(), HUGE_VAL), high(members.size(), -HUGE_VAL);
  for (std::size_t n = 0; n < group.size(); ++n) {
    const std::size_t a = group[n];
    ++members[a];
    low[a] = std::min(low[a], mesh.coordinates[3 * n]);
    high[a] = std::max(high[a], mesh.coordinates[3 * n]);
  }
  CHECK(*std::min_element(members.begin(), members.end()) >= 1);
  CHECK(static_cast<double>(nodes) / groups >= 8.0);
  int across = 0;
  for (std::size_t a = 0; a < members.size(); ++a) across += high[a] == low[a] ? 1 : 0;
  CHECK(across > groups * 9 / 10);
}

TEST_CASE("rows without neighbours do not make the groups of the others grow") {
  // A chain, and a third as many isolated rows, such as rows whose neighbours all belong to other ranks.
  constexpr std::int32_t joined = 3000, lone = 1000;
  WeightedGraph graph;
  graph.start.push_back(0);
  for (std::int32_t i = 0; i < joined + lone; ++i) {
    if (i > 0 && i < joined) graph.column.push_back(i - 1);
    if (i + 1 < joined) graph.column.push_back(i + 1);
    graph.start.push_back(static_cast<std::int64_t>(graph.column.size()));
  }
  graph.weight.assign(graph.column.size(), 1.0F);
  const auto group = aggregate(std::move(graph), 48.0);
  std::vector<int> members(1 + *std::max_element(group.begin(), group.end()), 0);
  for (const std::int32_t a : group) ++members[a];
  CHECK(*std::max_element(members.begin(), members.end()) <= 64);
  CHECK(std::count(members.begin(), members.end(), 1) == lone);
  CHECK(members.size() <= lone + joined / 24);
}

TEST_CASE("a level is symmetric, and the next one is its Galerkin matrix, on any number of ranks") {
  auto level = chain(9);
  auto x = wave(level, 0.7), y = wave(level, 1.9);
  std::vector<double> ax(level.owned_size()), ay(ax);
  level.multiply(x, ax);
  level.multiply(y, ay);
  CHECK(dot(ax, y, ax.size()) == doctest::Approx(dot(ay, x, ax.size())).epsilon(1e-12));
  CHECK(dot(ax, x, ax.size()) > 0.0);

  std::vector<std::int32_t> group(level.rows());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = static_cast<std::int32_t>(i / 3);
  const double length = 0.8;
  auto next = level.coarsened(group, length);
  CHECK(next.total() * 3 == level.total());
  auto c = wave(next, 1.1);
  std::vector<double> ac(next.owned_size()), p(level.size(), 0.0);
  next.multiply(c, ac);
  for (std::size_t i = 0; i < group.size(); ++i) {
    const std::size_t a = group[i];
    Vector3 offset{};
    for (std::size_t k = 0; k < 3; ++k) offset[k] = level.centres()[i][k] - next.centres()[a][k];
    RigidMotion<6>::add_to_part(&c[6 * a], offset.data(), 1.0 / length, &p[6 * i]);
  }
  level.multiply(p, ax);
  CHECK(dot(ac, c, ac.size()) == doctest::Approx(dot(ax, p, ax.size())).epsilon(1e-12));
}

TEST_CASE("iterations hardly depend on the mesh: size, element, stretch, contrast" *
          doctest::skip(sanitized)) {
  for (const auto type : {ElementType::tet4, ElementType::hex8, ElementType::tri3}) {
    CAPTURE(static_cast<int>(type));
    const bool grids = dimension(type) == 3;
    const int fine = type == ElementType::tri3 ? 40 : 12;
    const int small = iterations(long_beam(fine / 2, 3.0, type), 1.0),
              large = iterations(long_beam(fine, 3.0, type), 1.0);
    CHECK(small <= (grids ? 20 : 40));
    CHECK(large <= 1.5 * small);
    CHECK(iterations(long_beam(fine / 2, 30.0, type), 1.0) <= (grids ? 100 : 6 * small));
    CHECK(iterations(long_beam(fine / 2, 3.0, type), 0.1) <= 3 * small);
  }
}

TEST_CASE("a fine level with other blocks is as one made anew") {
  for (const ElementType type : {ElementType::hex8, ElementType::tet4, ElementType::tri3}) {
    CAPTURE(static_cast<int>(type));
    const Part part = long_beam(dimension(type) == 2 ? 8 : 3, 3.0, type);
    const std::size_t dim = part.dim();
    const Space space(part);
    Vector g(part.body().secant_count());
    for (std::size_t e = 0; e < g.size(); ++e) g[e] = 0.2 + static_cast<double>(e % 5);
    const auto blocks = [&](std::int64_t every) {
      std::vector<NodeBlock> all;
      for (std::int32_t n = 0; n < part.owned_nodes(); ++n) {
        if (part.node_index[static_cast<std::size_t>(n)] % every != 0) continue;
        all.push_back({n, {}});
        for (std::size_t c = 0; c < dim; ++c)
          all.back().value[c * dim + c] = 1e3 * static_cast<double>(1 + c);
      }
      return all;
    };
    FineLevel changed(multigrid_body(part), {}), anew(multigrid_body(part), {});
    changed.setup(g, {blocks(4), space.held()});
    changed.update({blocks(6), space.held()});
    anew.setup(g, {blocks(6), space.held()});
    const auto same = [](std::span<const float> x, std::span<const float> y) {
      return std::equal(x.begin(), x.end(), y.begin(), y.end());
    };
    CHECK(same(changed.inverse(), anew.inverse()));
    CHECK(same(changed.held_stiffness(), anew.held_stiffness()));
    CHECK(same(changed.own_stiffness(), anew.own_stiffness()));
  }
}

TEST_CASE("a factor takes what flow leaves of shear beside the bulk modulus") {
  for (const auto type : {ElementType::hex8, ElementType::tri3}) {
    CAPTURE(static_cast<int>(type));
    CHECK(iterations(long_beam(4, 3.0, type), 1e-7, "factor") <= 3);
  }
}

TEST_CASE("the smoother damps eigenvectors by Chebyshev's polynomial") {
  // Diagonal A and D = 2, b = 0: the error is reduced by T_k((θ − a/2)/δ)/T_k(θ/δ) in every entry.
  const std::vector<double> a{0.02, 0.3, 0.9, 1.4, 2.2};
  const std::vector<double> zero(a.size(), 0.0);
  for (const int degree : {1, 2, 3, 5}) {
    const Chebyshev smoother{degree, 0.1, 1.1};
    std::vector<double> x(a.size(), 1.0), step(a.size(), 7.0), image(a.size());
    const auto multiply = [&](std::span<const double> p, std::span<double> q) {
      for (std::size_t i = 0; i < a.size(); ++i) q[i] = a[i] * p[i];
    };
    const auto relax = [&](const ChebyshevStep<double>& weights, std::span<const double> b,
                           std::span<const double> ax, std::span<double> steps, std::span<double> to) {
      weights.visit([&]<bool from_zero, bool first>() {
        for (std::size_t i = 0; i < a.size(); ++i)
          weights.take<from_zero, first>((from_zero ? b[i] : b[i] - ax[i]) / 2.0, steps[i], to[i]);
      });
    };
    smoother.smooth<double>(false, {zero, x, step, image}, multiply, relax);
    const auto left = [&](double entry) {
      const auto chebyshev = [degree](double s) {
        return std::abs(s) <= 1.0
                   ? std::cos(degree * std::acos(s))
                   : std::pow(s < 0 ? -1.0 : 1.0, degree) * std::cosh(degree * std::acosh(std::abs(s)));
      };
      return chebyshev((0.6 - entry / 2.0) / 0.5) / chebyshev(0.6 / 0.5);
    };
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(x[i] == doctest::Approx(left(a[i])).epsilon(1e-12));
    // From zero, whatever x and step contain: A⁻¹ b minus the remaining error.
    std::vector<double> b(a.size(), 3.0);
    smoother.smooth<double>(true, {b, x, step, image}, multiply, relax);
    for (std::size_t i = 0; i < a.size(); ++i)
      CHECK(x[i] == doctest::Approx(3.0 / a[i] * (1.0 - left(a[i]))).epsilon(1e-12));
  }
}
