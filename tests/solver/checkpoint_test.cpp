// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints: a stopped run continues to the same answer on any number of ranks, and bitwise on the same
// number.
#include <doctest/doctest.h>

#include <string>

#include <kacanov/solve.hpp>
#include "support.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace {

Part part_of(const Mesh& mesh, const Model& model, MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::optional<Problem> problem;
  if (rank == 0) problem = build_problem(mesh, model);
  return distribute(problem ? &*problem : nullptr, comm);
}

struct Ending {
  Result result;
  std::vector<double> displacement;  ///< on rank 0, in the user's numbering
};

/// Runs from the beginning, or continues from `start` (rank 0).
Ending run(Part& part, const Model& model, RunOptions options = {}, const Checkpoint* start = nullptr) {
  options.start = start;
  const Solution solution = solve(part, model.solver, options);
  return {solution.result, gather_nodal(part, solution.displacement, part.dim())};
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return most == 0.0 ? 0.0 : most / size;
}

Model with(const Model& model, SolverOptions::Outer outer, SolverOptions::Contact contact) {
  Model other = model;
  other.solver.outer = outer;
  other.solver.contact = contact;
  return other;
}

}  // namespace

TEST_CASE("a run goes on from any of its checkpoints to the same answer, on other ranks too") {
  using Options = SolverOptions;
  const Mesh mesh = beam_mesh(2, 4);
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  model.solver.tolerance = 1e-8;
  Model coulomb = model;
  coulomb.contact[0].friction = Friction{0.0, 0.3};
  for (const Model& each : {model, coulomb, with(model, Options::Outer::kacanov, Options::Contact::admm)}) {
    Part together = part_of(mesh, each, MPI_COMM_WORLD), alone = part_of(mesh, each, MPI_COMM_SELF);
    const bool first = together.node_map.rank == 0;
    std::vector<Checkpoint> checkpoints;
    RunOptions options;
    if (first) options.checkpoint = [&](const Checkpoint& c) { checkpoints.push_back(c); };
    const Ending whole = run(together, each, options);
    REQUIRE(whole.result.status == Status::converged);
    // One checkpoint after each step but the last.
    const int steps = whole.result.outer_iterations;
    if (first) REQUIRE(static_cast<int>(checkpoints.size()) == steps - 1);
    for (const int at : {1, steps / 2, steps - 1}) {
      CAPTURE(at);
      Checkpoint from;
      if (first) from = checkpoints[at - 1];
      const Ending rest = run(together, each, {}, first ? &from : nullptr);
      CHECK(rest.result.status == Status::converged);
      CHECK(rest.result.restarted_after == at);
      CHECK(rest.result.outer_iterations == steps);
      CHECK(rest.result.r.size() == static_cast<std::size_t>(rest.result.outer_iterations));
      CHECK(rest.result.r_star == whole.result.r_star);
      if (first) CHECK(difference(rest.displacement, whole.displacement) < 1e-6);
      if (!first) continue;
      const Ending elsewhere = run(alone, each, {}, &from);
      CHECK(elsewhere.result.status == Status::converged);
      CHECK(difference(elsewhere.displacement, whole.displacement) < 1e-6);
    }
  }
}

TEST_CASE("a stop leaves the last whole step, on all ranks, wherever it comes") {
  const Mesh mesh = beam_mesh(2, 4);
  const Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  Part part = part_of(mesh, model, MPI_COMM_WORLD);
  const bool first = part.node_map.rank == 0, last = part.node_map.rank == part.node_map.ranks - 1;
  int questions = 0;
  RunOptions counting;
  counting.stop_requested = [&] { return ++questions < 0; };
  const Ending whole = run(part, model, counting);
  REQUIRE(whole.result.status == Status::converged);
  for (const double share : {0.0, 0.2, 0.6, 0.8, 0.95}) {
    CAPTURE(share);
    const int patience = static_cast<int>(share * questions);
    Checkpoint left;
    int asked = 0, written = 0;
    RunOptions options;
    // Only one rank receives the signal.
    options.stop_requested = [&] { return last && asked++ >= patience; };
    options.checkpoint_due = [] { return false; };
    options.checkpoint = [&](const Checkpoint& c) {
      left = c;
      ++written;
    };
    const Ending stopped = run(part, model, options);
    REQUIRE(stopped.result.status == Status::interrupted);
    CHECK((stopped.result.outer_iterations > 0 || share < 0.8));
    CHECK(stopped.result.outer_iterations < whole.result.outer_iterations);
    CHECK(written == (first ? 1 : 0));
    if (first) CHECK(difference(stopped.displacement, left.fields.at("displacement")) < 1e-15);
    const Ending rest = run(part, model, {}, first ? &left : nullptr);
    CHECK(rest.result.status == Status::converged);
    if (first) CHECK(difference(rest.displacement, whole.displacement) < 1e-5);
  }
}

TEST_CASE("what has not converged can be continued with more steps") {
  const Mesh mesh = beam_mesh(2, 4);
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  Part part = part_of(mesh, model, MPI_COMM_WORLD);
  const Ending whole = run(part, model);
  Checkpoint left;
  RunOptions options;
  options.checkpoint = [&](const Checkpoint& c) { left = c; };
  model.solver.max_outer = 3;
  CHECK(run(part, model, options).result.status == Status::not_converged);
  model.solver.max_outer = 100;
  const Ending rest = run(part, model, {}, part.node_map.rank == 0 ? &left : nullptr);
  CHECK(rest.result.status == Status::converged);
  CHECK(rest.result.restarted_after == 3);
  if (part.node_map.rank == 0) CHECK(difference(rest.displacement, whole.displacement) < 1e-5);
}

TEST_CASE("a run goes on by another method, with a penalty of its own") {
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  Part part = part_of(beam_mesh(2, 4), model, MPI_COMM_WORLD);
  const Ending whole = run(part, model);
  Model slow = with(model, SolverOptions::Outer::kacanov, SolverOptions::Contact::admm);
  slow.solver.penalty = SolverOptions::Penalty::fixed;
  slow.solver.r = 1e-6;
  slow.solver.max_contact = 2;
  slow.solver.max_outer = 20;
  Checkpoint left;
  RunOptions options;
  options.checkpoint = [&](const Checkpoint& c) { left = c; };
  CHECK(run(part, slow, options).result.status == Status::not_converged);
  const Ending rest = run(part, model, {}, part.node_map.rank == 0 ? &left : nullptr);
  CHECK(rest.result.status == Status::converged);
  CHECK(rest.result.restarted_after == 20);
  CHECK(rest.result.r.at(19) == 1e-6);
  CHECK(rest.result.r.at(20) > 1e-3);
  if (part.node_map.rank == 0) CHECK(difference(rest.displacement, whole.displacement) < 1e-5);
}

TEST_CASE("a fingerprint knows what differs") {
  const Mesh mesh = beam_mesh(2, 2);
  const Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  const auto print = [&](const Mesh& body, const Model& of) { return fingerprint(build_problem(body, of)); };
  const Fingerprint base = print(mesh, model);
  CHECK(base.differences(print(mesh, model)).empty());
  using Names = std::vector<std::string>;
  Model other = model;
  other.solver.tolerance = 1e-3;
  CHECK(base.differences(print(mesh, other)).empty());
  other.materials[0].law.form = laws::Logarithmic{0.02};
  CHECK(base.differences(print(mesh, other)) == Names{"material"});
  other = model;
  other.boundary[1].traction = Vector3{0.0, -0.06, 0.0};
  CHECK(base.differences(print(mesh, other)) == Names{"boundary"});
  other = model;
  other.contact[0].friction->tresca = 0.02;
  CHECK(base.differences(print(mesh, other)) == Names{"contact"});
  Mesh moved = mesh;
  map_nodes(moved, [](const Vector3& x) { return Vector3{x[0] * (1.0 + 1e-12), x[1], 0.0}; });
  const Names names = base.differences(print(moved, model));
  CHECK(std::find(names.begin(), names.end(), "mesh") != names.end());
}

namespace {

struct NamedProblem {
  std::string name;
  Mesh mesh;
  Model model;
};

Solution solved(const NamedProblem& given, RunOptions options) {
  const Model model = with_curves(given.model);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::optional<Problem> problem;
  if (rank == 0) problem = build_problem(given.mesh, model);
  Part part = distribute(problem ? &*problem : nullptr, MPI_COMM_WORLD);
  if (rank != 0) options.start = nullptr;
  return any_moves(model) ? solve_moving(part, model, options) : solve(part, model.solver, options);
}

/// Compares this rank's fields.
void check_same_bits(const Solution& a, const Solution& b) {
  CHECK(a.result.status == b.result.status);
  CHECK(a.result.outer_iterations == b.result.outer_iterations);
  CHECK(a.result.contact_iterations == b.result.contact_iterations);
  CHECK(a.result.cg_iterations == b.result.cg_iterations);
  CHECK(a.result.load_cuts == b.result.load_cuts);
  CHECK(a.result.load_reached == b.result.load_reached);
  CHECK(a.result.r == b.result.r);
  CHECK(a.displacement == b.displacement);
  CHECK(a.pressure == b.pressure);
  CHECK(a.traction == b.traction);
  CHECK(a.result.contact_force == b.result.contact_force);
  REQUIRE(a.result.load_steps.size() == b.result.load_steps.size());
  for (std::size_t k = 0; k < a.result.load_steps.size(); ++k) {
    CHECK(a.result.load_steps[k].probe == b.result.load_steps[k].probe);
    CHECK(a.result.load_steps[k].cg_iterations == b.result.load_steps[k].cg_iterations);
    CHECK(a.result.load_steps[k].outer_iterations == b.result.load_steps[k].outer_iterations);
  }
}

NamedProblem named_problem(std::string name, int dim, const Law& law, double tresca, double coulomb) {
  NamedProblem out{std::move(name), beam_mesh(dim, dim == 2 ? 4 : 2), beam(dim, law, 0.05, tresca)};
  if (coulomb > 0.0) out.model.contact[0].friction = Friction{tresca, coulomb};
  out.model.solver.tolerance = 1e-8;
  return out;
}

Law saturating(double x0) {
  Law law = elastic_law(1.0, 0.3);
  law.form = laws::Saturating{x0, 2.0};
  return law;
}

NamedProblem slab_over_ball() {
  NamedProblem out{"", make_box({{2, 1, 0.5}, {8, 4, 2}, ElementType::hex8}), {}};
  out.model.materials.push_back({everything(), elastic_law(200.0, 0.3)});
  out.model.boundary.push_back(moved(named("top"), 3));
  out.model.contact.push_back({named("bottom"), Sphere{{1, 0.5, -2}, 2.0, Vector3{0, 0, -1}}, std::nullopt});
  out.model.probes.push_back({1, 0.5, 0});
  return out;
}

std::vector<NamedProblem> problems() {
  using Options = SolverOptions;
  std::vector<NamedProblem> all;
  all.push_back(named_problem("Tresca", 2, logarithmic_law(0.01), 0.01, 0.0));
  all.push_back(named_problem("Coulomb", 2, logarithmic_law(0.01), 0.0, 0.3));
  all.push_back(named_problem("elastic", 2, elastic_law(1.0, 0.3), 0.0, 0.0));
  all.push_back(named_problem("Tresca in 3D", 3, logarithmic_law(0.01), 0.01, 0.0));
  all.push_back(named_problem("Coulomb in 3D", 3, saturating(0.01), 0.0, 0.3));
  all.push_back(named_problem("ADMM", 2, logarithmic_law(0.01), 0.01, 0.0));
  all.back().model.solver.outer = Options::Outer::kacanov;
  all.back().model.solver.contact = Options::Contact::admm;
  all.push_back(named_problem("a penalty of the user's", 2, logarithmic_law(0.01), 0.01, 0.0));
  all.back().model.solver.penalty = Options::Penalty::fixed;
  all.back().model.solver.r = 3.0;
  all.push_back(named_problem("r*", 2, logarithmic_law(0.01), 0.01, 0.0));
  all.back().model.solver.penalty = Options::Penalty::paper;
  all.push_back(named_problem("load steps", 2, logarithmic_law(0.01), 0.0, 0.3));
  all.back().model.solver.load_steps = {0.3, 0.6, 1.0};
  all.push_back(named_problem("slip counted by load steps", 2, logarithmic_law(0.01), 0.0, 0.3));
  all.back().model.solver.load_steps = {0.5, 1.0};
  all.back().model.contact[0].friction->reference = Friction::Reference::step;
  // The load exceeds the limit load: load steps are cut.
  all.push_back(named_problem("cut load steps", 2, saturating(0.002), 0.0, 0.0));
  all.back().model.solver.load_steps = {0.2, 1.0};
  all.push_back(slab_over_ball());
  all.back().name = "an obstacle that moves";
  all.back().model.contact[0].motion = Motion{{}, {{1.0, {0, 0, 0.01}, {}}, {2.0, {0.1, 0, 0.02}, {}}}};
  all.back().model.contact[0].friction = Friction{0.0, 0.2};
  all.back().model.solver.load_steps = {0.5, 1.0, 2.0};
  all.push_back(all.back());
  all.back().name = "a new obstacle";
  all.back().model.contact[0].relinearise = true;
  all.push_back(slab_over_ball());
  all.back().name = "an obstacle that is pushed";
  all.back().model.contact[0].force_controlled = ForceControl{0.3, {0, 0, 1}};
  all.back().model.solver.load_steps = {0.5, 1.0};
  return all;
}

}  // namespace

TEST_CASE("a run continues from any of its checkpoints with the same bits") {
  for (const NamedProblem& problem : problems()) {
    CAPTURE(problem.name);
    std::vector<Checkpoint> checkpoints;
    RunOptions options;
    options.checkpoint = [&](const Checkpoint& c) { checkpoints.push_back(c); };
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank != 0) options.checkpoint = nullptr;
    const Solution whole = solved(problem, options);
    auto count = static_cast<double>(checkpoints.size());
    MPI_Bcast(&count, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    REQUIRE(count > 2.0);
    if (problem.name == "cut load steps") CHECK(whole.result.load_cuts > 0);
    for (const double share : {0.0, 0.3, 0.5, 0.8, 0.99}) {
      const auto at = static_cast<std::size_t>(share * count);
      CAPTURE(at);
      RunOptions rest;
      if (rank == 0) rest.start = &checkpoints[at];
      const Solution solution = solved(problem, rest);
      CHECK(solution.result.restarted_after > 0);
      check_same_bits(solution, whole);
    }
  }
}

TEST_CASE("a run that is stopped at any operator application continues with the same bits") {
  for (const NamedProblem& problem : problems()) {
    CAPTURE(problem.name);
    int rank = 0, questions = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    RunOptions counting;
    counting.stop_requested = [&] { return ++questions < 0; };
    const Solution whole = solved(problem, counting);
    for (const double share : {0.15, 0.45, 0.75, 0.9}) {
      CAPTURE(share);
      const int patience = static_cast<int>(share * questions);
      Checkpoint left;
      int asked = 0;
      RunOptions options;
      options.stop_requested = [&] { return asked++ >= patience; };
      options.checkpoint_due = [] { return false; };
      if (rank == 0) options.checkpoint = [&](const Checkpoint& c) { left = c; };
      REQUIRE(solved(problem, options).result.status == Status::interrupted);
      RunOptions rest;
      rest.start = &left;
      check_same_bits(solved(problem, rest), whole);
    }
  }
}
