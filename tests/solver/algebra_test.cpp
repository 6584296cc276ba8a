// SPDX-License-Identifier: BSD-3-Clause
// Projections, constrained spaces, CG and multigrid, each checked against its defining property.
#include <doctest/doctest.h>

#include <Eigen/Core>
#include <numeric>

#include <kacanov/operator.hpp>
#include "../dense_algebra.hpp"
#include "contact/projections.hpp"
#include "contact/traces.hpp"
#include "dense.hpp"
#include "multigrid/cg.hpp"
#include "preconditioners.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

Vector random_vector(std::size_t n, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Vector x(n);
  for (double& v : x) v = uniform(engine);
  return x;
}

/// A 3D block with one fixed side and one side on rollers: some nodes are fixed, others in one component.
Part held_block() {
  Model model = elastic_model();
  model.boundary.push_back(moved(named("left"), 3));
  model.boundary.push_back(roller(named("front"), 1));
  model.contact.push_back(on_plane(named("bottom"), {}, {0.1, 0.2, 1}, 0.01));
  const Problem problem = build_problem(box_mesh(ElementType::tet4), model);
  return distribute(&problem, MPI_COMM_SELF);
}

}  // namespace

TEST_CASE("the normal step solves its one-point problem") {
  // φ minimises λ(w − φ) + r/2 (w − φ)² subject to φ ≤ gap, and λ₊ = λ + r(w − φ) is the multiplier.
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const double w = uniform(engine), lambda = uniform(engine), gap = uniform(engine),
                 r = 0.1 + 10 * std::abs(uniform(engine));
    const NormalStep step = normal_step(w, lambda, gap, r);
    CHECK(step.phi <= gap + 1e-14);
    CHECK(step.lambda >= 0.0);
    CHECK(step.lambda * (step.phi - gap) == doctest::Approx(0.0).epsilon(1e-13));
    CHECK(step.lambda == doctest::Approx(lambda + r * (w - step.phi)).epsilon(1e-12));
  }
}

TEST_CASE("the tangential step projects on a disc") {
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const double w[2] = {uniform(engine), uniform(engine)}, lambda[2] = {uniform(engine), uniform(engine)};
    const double bound = i % 10 == 0 ? 0.0 : std::abs(uniform(engine)),
                 r = 0.1 + 10 * std::abs(uniform(engine));
    const TangentialStep step = tangential_step(w, lambda, bound, r);
    const double size = std::hypot(step.lambda[0], step.lambda[1]),
                 slip = std::hypot(step.phi[0], step.phi[1]);
    CHECK(size <= bound * (1 + 1e-14));
    for (int k = 0; k < 2; ++k)
      CHECK(step.lambda[k] == doctest::Approx(lambda[k] + r * (w[k] - step.phi[k])).epsilon(1e-12));
    // Slip occurs only at the bound, along the friction force: ψ|φ| = λ·φ.
    CHECK(bound * slip ==
          doctest::Approx(step.lambda[0] * step.phi[0] + step.lambda[1] * step.phi[1]).epsilon(1e-12));
  }
}

TEST_CASE("the tangential bound is a disc, not a box") {
  const double w[2] = {3.0, 4.0}, lambda[2] = {0.0, 0.0};
  const TangentialStep step = tangential_step(w, lambda, 1.0, 1.0);
  CHECK(step.lambda[0] == doctest::Approx(0.6));
  CHECK(step.lambda[1] == doctest::Approx(0.8));
  CHECK(step.phi[0] == doctest::Approx(2.4));
  CHECK(step.phi[1] == doctest::Approx(3.2));
}

TEST_CASE("a space's projection is orthogonal") {
  const Part part = held_block();
  Space space(part);
  // Linearly dependent directions at one node, and a node that is fixed already.
  for (const auto& point : part.contact) {
    space.hold(point.node, point.normal);
    space.hold(point.node, {2 * point.normal[0], 2 * point.normal[1], 2 * point.normal[2]});
    space.hold(point.node, point.tangent[0]);
  }
  Vector x = random_vector(part.unknowns(), 3), y = random_vector(part.unknowns(), 4);
  Vector px = x, py = y;
  space.project(px);
  space.project(py);
  CHECK(space.dot(px, y) == doctest::Approx(space.dot(x, py)).epsilon(1e-13));
  Vector again = px;
  space.project(again);
  for (std::size_t i = 0; i < again.size(); ++i) CHECK(std::abs(again[i] - px[i]) < 1e-14);
  for (std::size_t i = 0; i < px.size(); ++i)
    if (part.held[i]) CHECK(px[i] == 0.0);
  for (const auto& point : part.contact) {
    const double* u = &px[3 * static_cast<std::size_t>(point.node)];
    CHECK(std::abs(u[0] * point.normal[0] + u[1] * point.normal[1] + u[2] * point.normal[2]) < 1e-14);
  }
}

TEST_CASE("dot products come in pairs at no other value") {
  const Part part = held_block();
  const Space space(part);
  const Vector a = random_vector(part.unknowns(), 5), b = random_vector(part.unknowns(), 6);
  const auto pair = space.dot2(a, b, b, b);
  CHECK(pair[0] == space.dot(a, b));
  CHECK(pair[1] == space.dot(b, b));
  double largest = 0.0;
  for (const double v : a) largest = std::max(largest, std::abs(v));
  CHECK(space.max_abs(a) == largest);
}

TEST_CASE("traces: force is the transpose of evaluation, penalty their product") {
  const Part part = held_block();
  const Traces traces(part);
  const Space space(part);
  Vector u = random_vector(part.unknowns(), 7), v = random_vector(part.unknowns(), 8);
  space.project(u);
  space.project(v);
  ContactValues nu(traces.size()), nv(traces.size());
  traces.evaluate(u, nu);
  traces.evaluate(v, nv);
  Vector force(part.unknowns(), 0.0);
  traces.add_force(nu, 1.0, force);
  double product = 0.0;
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const double m = part.contact[i].mass;
    product += m * (nu.normal[i] * nv.normal[i] + nu.tangential[2 * i] * nv.tangential[2 * i] +
                    nu.tangential[2 * i + 1] * nv.tangential[2 * i + 1]);
  }
  CHECK(space.dot(force, v) == doctest::Approx(product).epsilon(1e-12));
  CHECK(traces.force_norm(nu) == doctest::Approx(space.norm(force)).epsilon(1e-12));
  Vector penalty(part.unknowns(), 0.0);
  traces.add_penalty({1.0, 1.0}, u, penalty);
  for (std::size_t i = 0; i < penalty.size(); ++i) CHECK(std::abs(penalty[i] - force[i]) < 1e-14);
  // The bottom has area 2×1; the fixed nodes at x = 0 take away half a cell's width.
  double area = 0.0;
  for (const auto& point : part.contact) area += point.mass;
  CHECK(area == doctest::Approx(2.0 - 0.25).epsilon(1e-12));
}

TEST_CASE("multigrid is a symmetric positive definite map, and CG solves with it what a dense solve does") {
  const Part part = held_block();
  Vector g(part.body().secant_count());
  Operator op(part.body());
  op.secant(g);
  // A contact penalty at every contact node, as the solver adds it.
  const Traces traces(part);
  const double r = 3.0;
  std::vector<NodeBlock> blocks;
  for (std::size_t k = 0; k < part.contact.size(); ++k) {
    const RowEntry& entry = part.contact.entries(k).front();
    NodeBlock block{entry.node, {}};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        block.value[3 * i + j] = r * part.contact[k].mass * entry.trace[i] * entry.trace[j];
    blocks.push_back(block);
  }
  const Space space(part);
  Vector x = random_vector(part.unknowns(), 9), y = random_vector(part.unknowns(), 10);
  space.project(x);
  space.project(y);
  for (const char* kind : {"multigrid", "elasticity", "factor"}) {
    CAPTURE(kind);
    const auto amg = preconditioner_named(kind, part);
    amg->setup(g, blocks, space);
    Vector mx(x.size()), my(y.size());
    amg->apply(x, mx);
    amg->apply(y, my);
    // Multigrid uses single precision.
    const double rounding = std::string(kind) == "multigrid" ? 1e-5 : 1e-10;
    CHECK(std::abs(space.dot(mx, y) - space.dot(x, my)) <=
          rounding * std::sqrt(space.dot(mx, x) * space.dot(my, y)));
    CHECK(space.dot(mx, x) > 0.0);
    for (std::size_t i = 0; i < mx.size(); ++i)
      if (part.held[i]) CHECK(mx[i] == 0.0);

    const Eigen::VectorXd b =
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    Eigen::MatrixXd a = dense_stiffness(part, g);
    Eigen::MatrixXd c = dense_traces(part, false);
    a += r * product(c.transpose(), c);
    const auto free = free_components(part);
    const Eigen::VectorXd exact = solve_symmetric(a(free, free), b(free));

    CgWork work;
    work.resize(x.size());
    work.residual = x;
    Vector u(x.size(), 0.0);
    const CgResult solve = conjugate_gradients(
        space,
        [&](std::span<const double> p, std::span<double> q) {
          const double share = op.apply_dot(p, q);
          return share + traces.add_penalty({r, 0.0}, p, q);
        },
        [&](std::span<const double> p, std::span<double> q) { amg->apply(p, q); }, u, work,
        {0.0, 1e-12, 200});
    CHECK(solve.converged);
    CHECK(solve.iterations < (std::string(kind) == "factor" ? 4 : 60));
    CHECK(solve.residual <= 1e-12 * solve.first_residual);
    CHECK(solve.energy == doctest::Approx(exact.dot(b(free))).epsilon(1e-9));
    for (std::size_t i = 0; i < free.size(); ++i)
      CHECK(u[free[i]] ==
            doctest::Approx(exact(static_cast<Eigen::Index>(i))).epsilon(1e-9).scale(exact.norm()));
  }
}

TEST_CASE("CG stops at what its problem leaves out, and asks for that once") {
  const Part part = held_block();
  const Space space(part);
  Operator op(part.body());
  Vector g(part.body().secant_count());
  op.secant(g);
  const auto amg = preconditioner_named("multigrid", part);
  amg->setup(g, {}, space);
  Vector pull = random_vector(part.unknowns(), 12);
  space.project(pull);
  constexpr double first_asked = 0.2, share = 0.7;
  int asked = 0;
  double left_out = 0.0;
  const auto solve = [&](double relative) {
    CgWork work;
    work.resize(pull.size());
    work.residual = pull;
    Vector u(pull.size(), 0.0);
    CgOptions options{0.0, relative, 200};
    asked = 0;
    options.asked = first_asked, options.share = share, options.worth = 2.0;
    options.left_out = [&] {
      ++asked;
      std::fill(work.image.begin(), work.image.end(), 1e300);  // the callback may overwrite the work vector
      return left_out * space.norm(pull);
    };
    return conjugate_gradients(
        space, [&](std::span<const double> p, std::span<double> q) { return op.apply_dot(p, q); },
        [&](std::span<const double> p, std::span<double> q) { amg->apply(p, q); }, u, work, options);
  };
  const CgResult whole = solve(1e-8);
  CHECK(whole.converged);
  CHECK(asked == 1);
  left_out = 1e-3;
  const CgResult part_way = solve(1e-8);
  CHECK(part_way.converged);
  CHECK(asked == 1);
  CHECK(part_way.iterations < whole.iterations);
  CHECK(part_way.residual <= share * 1e-3 * part_way.first_residual);
  CHECK(part_way.residual > 1e-3 * 1e-3 * part_way.first_residual);
  left_out = 1.0;
  const CgResult at_once = solve(1e-8);
  CHECK(at_once.residual <= first_asked * at_once.first_residual);
  // With an easy target CG never calls back.
  CHECK(solve(0.5).converged);
  CHECK(asked == 0);
}

TEST_CASE("CG stops where the operator is not positive") {
  const Part part = held_block();
  const Space space(part);
  CgWork work;
  work.resize(part.unknowns());
  work.residual = random_vector(part.unknowns(), 11);
  Vector u(part.unknowns(), 0.0);
  const auto minus = [](std::span<const double> p, std::span<double> q) {
    for (std::size_t i = 0; i < p.size(); ++i) q[i] = -p[i];
    return -std::inner_product(p.begin(), p.end(), p.begin(), 0.0);
  };
  const auto same = [](std::span<const double> p, std::span<double> q) {
    std::copy(p.begin(), p.end(), q.begin());
  };
  const CgResult result = conjugate_gradients(space, minus, same, u, work, {});
  CHECK_FALSE(result.converged);
  for (const double v : u) CHECK(v == 0.0);
}
