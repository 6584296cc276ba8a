// SPDX-License-Identifier: BSD-3-Clause
// Contact rows over several nodes: mean displacements of facets pressed on a plane, on any number of ranks,
// against dense solves.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "contact/trace_rows.hpp"
#include "contact/traces.hpp"
#include "dense_solver.hpp"
#include "problem/integration.hpp"
#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

constexpr std::array row_types{ElementType::tri3, ElementType::tet4, ElementType::tet10, ElementType::hex8};

/// A second source of contact rows: a facet's mean displacement, weighted by area, against a plane.
void press_facet(const Problem& problem, std::int32_t facet, const Plane& plane, double tresca,
                 ConstraintRows& rows) {
  const Mesh& mesh = problem.mesh;
  const std::size_t dim = mesh.dim();
  const auto nodes = mesh.facet(facet);
  const FacetWeights weights = lumped_weights(mesh, facet);
  ContactPoint point;
  point.node = nodes[0];
  point.normal = (-1.0 / norm(plane.normal)) * plane.normal;
  point.tresca = tresca;
  if (tresca > 0.0) {
    const Vector3 some = dim == 2 ? Vector3{0, 0, 1} : Vector3{0.2, 1, 0.1}, t = cross(point.normal, some);
    point.tangent[0] = (1.0 / norm(t)) * t;
    point.tangents = 1;
    if (dim == 3) point.tangent[point.tangents++] = cross(point.normal, point.tangent[0]);
  }
  for (std::size_t k = 0; k < nodes.size(); ++k) point.mass += weights.area[k];
  std::vector<RowEntry> entries;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double share = weights.area[k] / point.mass;
    point.gap += share * dot(plane.point - position(mesh, nodes[k]), point.normal);
    RowEntry entry{nodes[k], share * point.normal, share * point.normal, {}};
    for (std::size_t t = 0; t < static_cast<std::size_t>(point.tangents); ++t)
      entry.tangent[t] = share * point.tangent[t];
    for (std::size_t c = 0; c < dim; ++c) {
      if (problem.held[static_cast<std::size_t>(nodes[k]) * dim + c] == 0) continue;
      entry.trace[c] = entry.tangent[0][c] = entry.tangent[1][c] = 0.0;
    }
    entries.push_back(entry);
  }
  rows.push_back(point, entries);
}

struct WideSample {
  Problem problem;
  Model model;
};

/// A block clamped at its left end and pressed on a plane slightly below. Left of `narrow_from` facets are in
/// contact by their means, right of it single nodes.
WideSample pressed_block(ElementType type, double narrow_from, double tresca, double load = 0.15) {
  WideSample sample;
  const Mesh mesh = box_mesh(type);
  const int dim = mesh.dim();
  const std::size_t up = dim - 1;
  Vector3 below{}, normal{};
  below[up] = -0.01;
  normal[up] = 1.0;
  normal[0] = 0.1;
  Model& model = sample.model;
  model.materials.push_back({everything(), logarithmic_law(0.08)});
  model.boundary.push_back(moved(named("left"), dim));
  model.boundary.push_back(pressure(named("top"), load));
  model.contact.push_back(on_plane(named("bottom"), below, normal, tresca));
  model.solver.tolerance = 1e-8;
  model.solver.max_outer = 400;
  sample.problem = build_problem(mesh, model);
  Problem& problem = sample.problem;
  ConstraintRows rows;
  const auto facets = Selection(mesh).facets(named("bottom"), "");
  for (const std::int32_t f : facets) {
    const auto nodes = mesh.facet(f);
    const bool left = std::all_of(nodes.begin(), nodes.end(),
                                  [&](std::int32_t n) { return position(mesh, n)[0] <= narrow_from + 1e-9; });
    if (left) press_facet(problem, f, {below, normal}, tresca, rows);
  }
  for (std::size_t i = 0; i < problem.contact.size(); ++i)
    if (position(mesh, problem.contact[i].node)[0] >= narrow_from - 1e-9)
      rows.push_back(problem.contact[i], problem.contact.entries(i));
  problem.contact = rows;
  return sample;
}

const Problem* on_first(const Problem& problem) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0 ? &problem : nullptr;
}

double sign_of(std::int64_t node, std::size_t c) {
  return std::sin(1.3 * static_cast<double>(node) + 0.7 * static_cast<double>(c));
}

/// A consistent vector that does not depend on the partitioning, zero at prescribed displacements.
Vector some_vector(const Part& part, double turn) {
  const std::size_t dim = part.dim();
  Vector x(part.unknowns());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = part.held[i] ? 0.0 : std::sin(turn + 3.0 * sign_of(part.node_index[i / dim], i % dim));
  return x;
}

void check_copies(const Part& part, const Vector& y) {
  Vector copy = y;
  part.node_map.forward(copy, part.dim());
  CHECK(copy == y);
}

}  // namespace

TEST_CASE("wide rows: forces are the transpose of traces on any number of ranks, copies the same bits") {
  for (const ElementType type : row_types) {
    CAPTURE(static_cast<int>(type));
    const WideSample sample = pressed_block(type, 1.0, 0.01);
    const Part part = distribute(on_first(sample.problem), MPI_COMM_WORLD);
    const Part whole = distribute(&sample.problem, MPI_COMM_SELF);
    const Traces traces(part), alone(whole);
    const Space space(part);
    const Vector u = some_vector(part, 0.3), v = some_vector(part, 1.1);
    ContactValues nu(traces.size()), nv(traces.size()), all(alone.size());
    traces.evaluate(u, nu);
    traces.evaluate(v, nv);
    alone.evaluate(some_vector(whole, 0.3), all);
    double product = 0.0;
    for (std::size_t i = 0; i < traces.owned(); ++i) {
      const double m = part.contact[i].mass;
      product += m * nu.normal[i] * nv.normal[i];
      for (std::size_t k = 2 * i; k < 2 * i + 2; ++k) product += m * nu.tangential[k] * nv.tangential[k];
      // The row alone, in the problem's numbering.
      const auto index = part.contact_index[i];
      const auto at =
          static_cast<std::size_t>(std::find(whole.contact_index.begin(), whole.contact_index.end(), index) -
                                   whole.contact_index.begin());
      CHECK(nu.normal[i] == doctest::Approx(all.normal[at]).epsilon(1e-13));
    }
    product = part.node_map.sum_all(product);
    Vector force(part.unknowns(), 0.0), penalty(part.unknowns(), 0.0);
    traces.add_force(nu, 1.0, force);
    CHECK(space.dot(force, v) == doctest::Approx(product).epsilon(1e-12));
    CHECK(traces.force_norm(nu) == doctest::Approx(space.norm(force)).epsilon(1e-12));
    CHECK(traces.force_norm(nu) == doctest::Approx(alone.force_norm(all)).epsilon(1e-12));
    const double share = traces.add_penalty({1.0, 1.0}, u, penalty);
    CHECK(part.node_map.sum_all(share) == doctest::Approx(space.dot(u, penalty)).epsilon(1e-12));
    for (std::size_t i = 0; i < penalty.size(); ++i) CHECK(std::abs(penalty[i] - force[i]) < 1e-14);
    check_copies(part, force);
    check_copies(part, penalty);
  }
}

TEST_CASE("wide rows are held by an orthogonal projection, and lifted by a pseudo-inverse") {
  for (const ElementType type : row_types) {
    CAPTURE(static_cast<int>(type));
    // Means over the triangles of tet4 are linearly dependent.
    const WideSample sample = pressed_block(type, 1.0, 0.01);
    const Part part = distribute(on_first(sample.problem), MPI_COMM_WORLD);
    const TraceRows rows(part, std::vector<TraceChoice>(part.contact.size(), {true, true}));
    const auto norm = [&](const Vector& x) {
      double sum = 0.0;
      for (std::size_t i = 0; i < rows.owned(); ++i) sum += x[i] * x[i];
      return std::sqrt(part.node_map.sum_all(sum));
    };
    const Space free(part);
    Space space(part);
    rows.hold_in(space);
    const Vector u = some_vector(part, 0.3), v = some_vector(part, 1.1);
    Vector pu = u, pv = v, x(rows.owned());
    space.project(pu);
    space.project(pv);
    check_copies(part, pu);
    CHECK(space.dot(pu, v) == doctest::Approx(space.dot(u, pv)).epsilon(1e-11));
    rows.apply(u, x);
    const double size = norm(x);
    rows.apply(pu, x);
    CHECK(norm(x) < 1e-11 * size);
    // The projected-out part lies in the span of the rows: u − Pu = C⁺ C u.
    rows.apply(u, x);
    Vector lifted(part.unknowns());
    rows.lift(x, lifted);
    check_copies(part, lifted);
    for (std::size_t i = 0; i < u.size(); ++i)
      CHECK(u[i] - pu[i] == doctest::Approx(lifted[i]).epsilon(1e-9).scale(1.0));
    // (C⁺)ᵀ: x·((C⁺)ᵀ v) = (C⁺ x)·v, bitwise the same on ghosts.
    Vector back(rows.local()), owned(rows.owned());
    rows.lift_transpose(v, back);
    rows.lift_transpose(v, owned);
    double product = 0.0;
    for (std::size_t i = 0; i < owned.size(); ++i) {
      CHECK(back[i] == owned[i]);
      product += x[i] * owned[i];
    }
    CHECK(part.node_map.sum_all(product) == doctest::Approx(free.dot(lifted, v)).epsilon(1e-10));
    // Node blocks are the block diagonal of r CᵀDC.
    Vector diagonal(part.unknowns(), 0.0), unit(part.unknowns(), 0.0), image(part.unknowns());
    const std::size_t dim = part.dim();
    for (const NodeBlock& block : rows.penalty_blocks(2.0))
      for (std::size_t c = 0; c < dim; ++c)
        diagonal[static_cast<std::size_t>(block.node) * dim + c] += block.value[c * dim + c];
    for (std::size_t n = 0; n < static_cast<std::size_t>(sample.problem.mesh.node_count()); n += 7) {
      std::fill(unit.begin(), unit.end(), 0.0);
      std::size_t here = part.nodes();
      for (std::size_t i = 0; i < part.nodes(); ++i)
        if (part.node_index[i] == static_cast<std::int32_t>(n)) here = i;
      if (here < part.nodes()) unit[here * dim] = 1.0;
      rows.apply(unit, x);
      rows.transpose(x, image);
      if (here < static_cast<std::size_t>(part.owned_nodes()))
        CHECK(diagonal[here * dim] == doctest::Approx(2.0 * image[here * dim]).epsilon(1e-12).scale(1e-6));
    }
  }
}

TEST_CASE("wide rows: every contact method finds what a dense solver finds, on any number of ranks") {
  using Contact = SolverOptions::Contact;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  for (const ElementType type : row_types)
    for (const double narrow_from : {1.0, 5.0})  // both kinds together, wide rows alone
      for (const double tresca : {0.0, 0.01}) {
        WideSample sample = pressed_block(type, narrow_from, tresca);
        DenseSolver dense(sample.problem);
        const DenseSolver::Answer answer = dense.solve();
        REQUIRE(answer.converged);
        CHECK(answer.forces.maxCoeff() > 0.0);
        for (const Contact contact :
             {Contact::admm, Contact::automatic, Contact::dual_admm, Contact::active_set}) {
          // Ranks that share cores mostly wait for each other, so test fewer cases.
          const bool distributed = contact == Contact::admm || contact == Contact::automatic;
          if (ranks > 1 && (!distributed || tresca == 0.0)) continue;
          CAPTURE(static_cast<int>(type));
          CAPTURE(narrow_from);
          CAPTURE(tresca);
          CAPTURE(static_cast<int>(contact));
          sample.model.solver.contact = contact;
          Part part = distribute(on_first(sample.problem), MPI_COMM_WORLD);
          const Solution solution = solve(part, sample.model.solver, {});
          CAPTURE(solution.result.message);
          CHECK(solution.result.status == Status::converged);
          // As many as with narrow rows: the constraints do not harm the preconditioner.
          if (contact == Contact::automatic) CHECK(solution.result.cg_iterations < 200);
          const std::vector<double> u = gather_nodal(part, solution.displacement, part.dim());
          if (part.node_map.rank > 0) continue;
          const Eigen::Map<const Eigen::VectorXd> all(u.data(), static_cast<Eigen::Index>(u.size()));
          CHECK((all - answer.u).norm() <= 1e-6 * answer.u.norm());
        }
      }
}

TEST_CASE("wide rows: Coulomb friction follows the pressure inside the Newton step") {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  // Means over the triangles of tet4 are linearly dependent: their pressures, and so the bounds, are not
  // unique.
  for (const ElementType type : {ElementType::tri3, ElementType::tet10, ElementType::hex8})
    for (const double narrow_from : {1.0, 5.0}) {
      CAPTURE(static_cast<int>(type));
      CAPTURE(narrow_from);
      WideSample sample = pressed_block(type, narrow_from, 1e-12);
      for (ContactPoint& point : sample.problem.contact) point.coulomb = 0.3;
      Part part = distribute(on_first(sample.problem), MPI_COMM_WORLD);
      const Solution solution = solve(part, sample.model.solver, {});
      CAPTURE(solution.result.message);
      CHECK(solution.result.status == Status::converged);
      CHECK(solution.result.slip_nodes > 0);
      // With bounds from the previous pressure: 10 to 12, and 17 to 19 with narrow points beside the wide
      // ones.
      CHECK(solution.result.outer_iterations <= (narrow_from > 2.0 ? 8 : 32));
      if (ranks > 1) continue;
      sample.model.solver.contact = SolverOptions::Contact::admm;
      const Solution fixed = solve(part, sample.model.solver, {});
      CHECK(fixed.result.status == Status::converged);
      double most = 0.0, size = 0.0;
      for (std::size_t i = 0; i < part.unknowns(); ++i) {
        most = std::max(most, std::abs(solution.displacement[i] - fixed.displacement[i]));
        size = std::max(size, std::abs(fixed.displacement[i]));
      }
      CHECK(most < 1e-5 * size);
    }
}

TEST_CASE("wide rows: the assembled preconditioner takes nodes that a rank has for its rows alone") {
  WideSample sample = pressed_block(ElementType::hex8, 5.0, 0.01);
  sample.model.solver.preconditioner = SolverOptions::Preconditioner::elasticity;
  Part part = distribute(on_first(sample.problem), MPI_COMM_WORLD);
  CHECK(solve(part, sample.model.solver, {}).result.status == Status::converged);
}
