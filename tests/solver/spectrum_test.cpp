// SPDX-License-Identifier: BSD-3-Clause
// λ_min, λ_max and r* against dense eigenvalues, in ordinary cases and where Lanczos breaks down.
#include "spectrum/spectrum.hpp"

#include <doctest/doctest.h>

#include "../dense_algebra.hpp"
#include "dense.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

SolverOptions with_tolerance(double tolerance) {
  SolverOptions options;
  options.spectrum_tolerance = tolerance;
  return options;
}

/// Compares both spectra of a problem with the dense ones, at the default tolerance, a loose and a tight one.
void compare(const Problem& problem, bool friction) {
  const Part part = distribute(&problem, MPI_COMM_SELF);
  for (const double tolerance : {0.2, 1e-2, 1e-9}) {
    const auto found = analyse_spectrum(part, with_tolerance(tolerance), {});
    REQUIRE(found.size() == (friction ? 2u : 1u));
    for (const auto& entry : found) {
      const Eigen::VectorXd dense = dense_spectrum(part, entry.friction);
      const double low = dense(0), high = dense(dense.size() - 1);
      CAPTURE(entry.friction);
      CAPTURE(tolerance);
      CAPTURE(entry.traces);
      CHECK(entry.lambda_min == doctest::Approx(low).epsilon(std::max(tolerance, 1e-7)));
      CHECK(entry.lambda_max == doctest::Approx(high).epsilon(std::max(tolerance, 1e-7)));
      CHECK(entry.r_star == doctest::Approx(1.0 / std::sqrt(low * high)).epsilon(std::max(tolerance, 1e-7)));
      // Within the error bounds, up to the rounding of the dense eigenvalues.
      CHECK(std::abs(entry.lambda_min - low) <= entry.bound_min + 1e-11 * low);
      CHECK(std::abs(entry.lambda_max - high) <= entry.bound_max + 1e-11 * high);
      CHECK(entry.bound_min <= 2 * tolerance * entry.lambda_min);
      CHECK(entry.bound_max <= 2 * tolerance * entry.lambda_max);
    }
  }
}

/// A box of random size, sheared, rotated and perturbed inside.
Mesh random_box(int dim, std::mt19937& engine, Rotation& rotation, Vector3& shear) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  BoxSpec spec;
  spec.type = dim == 2 ? ElementType::tri3 : ElementType::tet4;
  for (std::size_t c = 0; c < 3; ++c) spec.size[c] = 0.5 + 2.0 * uniform(engine);
  const int least = dim == 2 ? 3 : 1;
  for (int& cells : spec.cells) cells = least + static_cast<int>(3 * uniform(engine));
  spec.cells[0] *= dim == 2 ? 4 : 2;
  Mesh mesh = make_box(spec);
  shear = {0.4 * (uniform(engine) - 0.5), 0.4 * (uniform(engine) - 0.5), 0};
  rotation = Rotation(dim, 3.0 * uniform(engine));
  const std::size_t last = dim - 1;
  const double cell = spec.size[last] / spec.cells[last];
  map_nodes(mesh, [&](Vector3 x) {
    const double height = x[last];
    const bool inside = height > 1e-9 && height < spec.size[last] * (1 - 1e-9);
    for (std::size_t c = 0; c < last; ++c) x[c] += shear[c] * height;
    if (inside) x[last] += 0.2 * cell * (uniform(engine) - 0.5);
    return rotation(x);
  });
  return mesh;
}

}  // namespace

TEST_CASE("spectra of random bodies on oblique planes") {
  std::mt19937 engine(7);
  for (const int dim : {2, 3})
    for (int repeat = 0; repeat < 4; ++repeat) {
      Rotation rotation(dim, 0.0);
      Vector3 shear{};
      Mesh mesh = random_box(dim, engine, rotation, shear);
      Model model;
      model.materials.push_back({everything(), elastic_law(1.0 + repeat, 0.1 + 0.1 * repeat)});
      model.boundary.push_back(moved(named("left"), dim));
      const Vector3 up = rotation(dim == 2 ? Vector3{0.1, 1, 0} : Vector3{0.1, -0.2, 1});
      const bool friction = repeat % 2 == 1;
      model.contact.push_back(on_plane(named("bottom"), {-5, -5, -5}, up, friction ? 0.1 : 0.0));
      CAPTURE(dim);
      CAPTURE(repeat);
      compare(build_problem(std::move(mesh), model), friction);
    }
}

TEST_CASE("contact nodes that boundary conditions hold in part") {
  Model model = elastic_model();
  model.boundary.push_back(moved(named("left"), 3));
  model.boundary.push_back(roller(named("front"), 1));
  model.contact.push_back(on_plane(named("bottom"), {}, {0.3, 0.5, 1}, 0.1));
  compare(build_problem(box_mesh(ElementType::tet4), model), true);
}

TEST_CASE("two contact entries that meet at an edge") {
  for (const ElementType type : {ElementType::tri3, ElementType::quad4, ElementType::tet4}) {
    const int dim = dimension(type);
    Model model = elastic_model();
    model.boundary.push_back(moved(named("left"), dim));
    const Vector3 up = dim == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1};
    model.contact.push_back(on_plane(named("bottom"), {}, up, 0.1));
    model.contact.push_back(on_plane(named("right"), {2, 0, 0}, {-1, 0.2, 0}, 0.1));
    // At the edge the rows of [N; T] are linearly dependent: zero eigenvalues that must not be returned.
    compare(build_problem(box_mesh(type, {2, 1, 0.5}, 3), model), true);
  }
}

TEST_CASE("a square of one element: compliances 1 and 2 within their bounds, whatever the solves leave") {
  BoxSpec spec;
  spec.type = ElementType::quad4;
  Model model;
  model.materials.push_back({everything(), elastic_law(1.0, 0.0)});
  model.boundary.push_back(moved(named("top"), 2));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 1, 0}));
  const Problem problem = build_problem(make_box(spec), model);
  compare(problem, false);
  const Part part = distribute(&problem, MPI_COMM_SELF);
  for (const double tolerance : {0.5, 1e-1, 1e-2, 1e-4}) {
    const SpectrumResult found = analyse_spectrum(part, with_tolerance(tolerance), {})[0];
    CHECK(std::abs(found.lambda_min - 1.0) <= found.bound_min);
    CHECK(std::abs(found.lambda_max - 2.0) <= found.bound_max);
    CHECK(found.bound_max <= 2 * tolerance * found.lambda_max);
  }
}

TEST_CASE("one and two contact nodes") {
  BoxSpec spec;
  spec.type = ElementType::tri3;
  Model model = elastic_model();
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 1, 0}));
  model.boundary.push_back(moved(named("top"), 2));
  SUBCASE("two nodes") { compare(build_problem(make_box(spec), model), false); }
  SUBCASE("two nodes with friction") {
    model.contact[0].friction = Friction{0.1, 0.0};
    compare(build_problem(make_box(spec), model), true);
  }
  SUBCASE("one node") {
    model.boundary.push_back(moved(named("left"), 2));
    compare(build_problem(make_box(spec), model), false);
  }
}

TEST_CASE("K = c·I, beyond the size that is solved densely") {
  // Separate triangles, each with two fixed corners and one in contact, so that all contact nodes have the
  // same compliance.
  constexpr std::int32_t count = 40;
  Mesh mesh;
  mesh.type = ElementType::tri3;
  for (std::int32_t i = 0; i < count; ++i) {
    const double x = 2.0 * i;
    mesh.coordinates.insert(mesh.coordinates.end(), {x, 0, x + 1, 0, x, 1});
    mesh.elements.insert(mesh.elements.end(), {3 * i, 3 * i + 1, 3 * i + 2});
  }
  find_boundary(mesh);
  Model model = elastic_model();
  model.boundary.push_back(moved(everything(), 2));
  model.contact.push_back(on_plane(everything(), {}, {0, 1, 0}));
  // Release the first corners again: fix the others by a group.
  Group others{"others", 0, {}};
  for (std::int32_t i = 0; i < count; ++i)
    others.members.insert(others.members.end(), {3 * i + 1, 3 * i + 2});
  mesh.groups.push_back(others);
  model.boundary[0].on = named("others");
  const Problem problem = build_problem(mesh, model);
  REQUIRE(problem.contact.size() == count);
  compare(problem, false);
}

TEST_CASE("rigid modes that only the contact holds have no eigenvalue") {
  // The block may sink and rotate until it touches: λ_max is the largest finite eigenvalue, computed as 1/μ
  // of the generalised problem S v = μ M v without μ = 0.
  for (const ElementType type : {ElementType::tri3, ElementType::tet4}) {
    const int dim = dimension(type);
    Model model = elastic_model();
    model.boundary.push_back(roller(named("left"), 0));
    if (dim == 3) model.boundary.push_back(roller(named("front"), 1));
    model.contact.push_back(on_plane(named("bottom"), {}, dim == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1}));
    const Problem problem = build_problem(box_mesh(type, {2, 1, 0.5}, 4), model);
    REQUIRE(problem.loose_modes == 1);
    const Part part = distribute(&problem, MPI_COMM_SELF);
    const auto found = analyse_spectrum(part, with_tolerance(1e-8), {});

    std::vector<double> g(part.body().secant_count());
    reference::secant(part.body(), std::vector<double>(part.unknowns(), 0.0), g);
    const auto free = free_components(part);
    const Eigen::MatrixXd b = dense_stiffness(part, g)(free, free);
    const Eigen::MatrixXd c = dense_traces(part, false)(Eigen::all, free);
    // With the penalty r CᵀC the eigenvalues are λ/(1 + rλ), and 1/r for the rigid mode.
    const double r = 1e-2;
    const Eigen::MatrixXd k = schur_complement(b + r * product(c.transpose(), c), c);
    const Eigen::VectorXd theta = r * symmetric_eigenvalues(k);
    const Eigen::Index m = theta.size();
    CHECK(theta(m - 1) == doctest::Approx(1.0).epsilon(1e-9));
    CHECK(found[0].lambda_max == doctest::Approx(theta(m - 2) / (1 - theta(m - 2)) / r).epsilon(1e-6));
    CHECK(found[0].lambda_min == doctest::Approx(theta(0) / (1 - theta(0)) / r).epsilon(1e-6));
  }
}

TEST_CASE("rows of traces: transpose and pseudo-inverse") {
  Model model = elastic_model();
  model.boundary.push_back(moved(named("left"), 3));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0.1, 1}, 0.1));
  model.contact.push_back(on_plane(named("right"), {2, 0, 0}, {-1, 0, 0.2}, 0.1));
  const Problem problem = build_problem(box_mesh(ElementType::tet4), model);
  const Part part = distribute(&problem, MPI_COMM_SELF);
  const std::vector<TraceChoice> all(part.contact.size(), {true, true});
  const TraceRows rows(part, all);
  const Eigen::MatrixXd c = dense_traces(part, true);
  REQUIRE(rows.owned() == static_cast<std::size_t>(c.rows()));
  const Eigen::MatrixXd inverse = pseudo_inverse(c);
  Eigen::VectorXd x = Eigen::VectorXd::Random(c.rows()), y = Eigen::VectorXd::Random(c.cols());
  Eigen::VectorXd out_x(c.rows()), out_y(c.cols());
  const auto view = [](Eigen::VectorXd& v) { return std::span<double>(v.data(), v.size()); };
  rows.transpose(view(x), view(out_y));
  CHECK((out_y - c.transpose() * x).norm() < 1e-12);
  rows.apply(view(y), view(out_x));
  CHECK((out_x - c * y).norm() < 1e-12);
  rows.lift(view(x), view(out_y));
  CHECK((out_y - inverse * x).norm() < 1e-8 * inverse.norm());
  rows.lift_transpose(view(y), view(out_x));
  CHECK((out_x - inverse.transpose() * y).norm() < 1e-8 * inverse.norm());
  Eigen::MatrixXd penalty = 2.0 * product(c.transpose(), c);
  for (const NodeBlock& block : rows.penalty_blocks(2.0))
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = 0; j < 3; ++j)
        penalty(3 * block.node + i, 3 * block.node + j) -= block.value[3 * i + j];
  CHECK(penalty.norm() < 1e-12);
}

TEST_CASE("r_A of a solution is that of its contact set") {
  Model model = beam(2, elastic_law(1.0, 0.3), 0.05);
  model.solver.contact = SolverOptions::Contact::admm;
  const Run run = run_alone(beam_mesh(2, 8), model);
  REQUIRE(run.result().status == Status::converged);
  std::vector<double> g(run.part.body().secant_count());
  reference::secant(run.part.body(), std::vector<double>(run.part.unknowns(), 0.0), g);
  const auto components = free_components(run.part);
  const Eigen::MatrixXd b = dense_stiffness(run.part, g)(components, components);
  const Eigen::MatrixXd c = dense_traces(run.part, false)(Eigen::all, components);
  const Eigen::MatrixXd k = schur_complement(b, c);
  std::vector<int> active, open;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i)
    (run.solution.pressure[i] > 0.0 ? active : open).push_back(static_cast<int>(i));
  const Eigen::MatrixXd held = k(active, active);
  const Eigen::MatrixXd rest = k(open, open) - schur_complement(held, k(open, active));
  const double low = symmetric_eigenvalues(held).minCoeff();
  const double high = symmetric_eigenvalues(rest).maxCoeff();
  CHECK(active_penalty(run.part, run.solution, model.solver, {}).r ==
        doctest::Approx(1.0 / std::sqrt(low * high)).epsilon(0.02));
}

TEST_CASE("a run's own estimates are rough, and cost next to nothing") {
  for (const int dim : {2, 3})
    for (const double tresca : {0.0, 0.01}) {
      CAPTURE(dim);
      CAPTURE(tresca);
      const Run run =
          run_alone(beam_mesh(dim, dim == 2 ? 16 : 4), beam(dim, logarithmic_law(0.01), 0.05, tresca));
      const Result& result = run.result();
      CHECK(result.status == Status::converged);
      CHECK(static_cast<double>(result.spectrum_applications) <
            0.05 * static_cast<double>(result.operator_applications));
      const auto exact = analyse_spectrum(run.part, {}, {}).back();
      for (const double ratio : {result.lambda_min / exact.lambda_min, result.lambda_max / exact.lambda_max,
                                 result.r_star / exact.r_star}) {
        CHECK(ratio > 1.0 / 3.0);
        CHECK(ratio < 3.0);
      }
    }
}
