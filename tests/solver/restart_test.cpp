// SPDX-License-Identifier: BSD-3-Clause
// A restart on the same number of ranks repeats the steps of the uninterrupted run bitwise, wherever the run
// was stopped.
#include <doctest/doctest.h>

#include <string>

#include <kacanov/solve.hpp>
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

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
  all.back().name = "an obstacle faced anew";
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
