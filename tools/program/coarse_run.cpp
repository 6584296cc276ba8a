// SPDX-License-Identifier: BSD-3-Clause
// Nested iteration: solves a case on coarser meshes first, each from the one before.
#include "program/coarse_run.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <string>

#include <kacanov/discretisation.hpp>
#include <kacanov/error.hpp>
#include <kacanov/solve.hpp>
#include "program/loaded_case.hpp"
#include "program/obstacle_files.hpp"
#include "program/report.hpp"

namespace kacanov {
namespace {

/// Meshes with fewer unknowns are solved directly: a coarser one would cost as much as it saves.
constexpr std::int64_t least_fine = 1000, least_coarse = 100;
/// Tolerance on coarser meshes: interpolation adds a larger error.
constexpr double coarse_tolerance = 1e-3;

std::int64_t unknowns_of(const BoxSpec& box) {
  const std::int64_t dim = dimension(box.type);
  std::int64_t nodes = 1;
  for (std::int64_t c = 0; c < dim; ++c)
    nodes *= static_cast<std::int64_t>(box.cells[c]) * cell(box.type).order + 1;
  return nodes * dim;
}

/// Generator of a coarser mesh, called on the first rank.
struct Coarser {
  std::function<Mesh()> make;
  bool halves = true;      ///< it has the edges of the previous mesh halved
  std::string named = {};  ///< case key of its file; empty if the program generates it
};

/// Returns boxes with half the cells per axis each time, coarsest first.
std::vector<BoxSpec> coarser_boxes(const BoxSpec& fine) {
  std::vector<BoxSpec> boxes;
  if (unknowns_of(fine) < least_fine) return boxes;
  BoxSpec box = fine;
  const auto dim = static_cast<std::size_t>(dimension(fine.type));
  while (true) {
    if (*std::min_element(box.cells.begin(), box.cells.begin() + static_cast<std::ptrdiff_t>(dim)) < 4) break;
    for (std::size_t c = 0; c < dim; ++c) box.cells[c] /= 2;
    if (unknowns_of(box) < least_coarse) break;
    boxes.push_back(box);
  }
  std::reverse(boxes.begin(), boxes.end());
  return boxes;
}

/// Returns the coarser meshes of a case, coarsest first.
std::vector<Coarser> coarser_meshes(const MeshSource& mesh) {
  std::vector<Coarser> meshes;
  if (mesh.box)
    for (const BoxSpec& box : coarser_boxes(*mesh.box)) meshes.push_back({[box] { return make_box(box); }});
  for (std::size_t k = 0; k < mesh.coarser.size(); ++k) {
    MeshSource coarse;
    coarse.file = mesh.coarser[k];
    coarse.order = mesh.order;
    meshes.push_back(
        {[coarse] { return load_mesh(coarse); }, false, "mesh.files[" + std::to_string(k) + "]"});
  }
  MeshSource coarse = mesh;
  for (coarse.refine = 0; mesh.file && coarse.refine < mesh.refine; ++coarse.refine)
    meshes.push_back({[coarse] { return load_mesh(coarse); }, coarse.refine > 0});
  return meshes;
}

/// Applies the case to this mesh, without probes if one lies outside.
Problem put_on(const Case& input, Mesh mesh) {
  Model model = model_with_files(input);
  if (!model.probes.empty()) try {
      return build_problem(mesh, model);
    } catch (const InputError&) {
      model.probes.clear();
    }
  return build_problem(std::move(mesh), model);
}

/// Throws InputError if a file named in the case is not a mesh of a body of this dimension.
Mesh load_coarser(const Coarser& coarser, std::size_t dim) try {
  Mesh mesh = coarser.make();
  if (static_cast<std::size_t>(mesh.dim()) != dim)
    throw InputError("expected a mesh in " + std::to_string(dim) + "D, as the last one is");
  return mesh;
} catch (const InputError& error) {
  if (coarser.named.empty()) throw;
  throw InputError(coarser.named + ": " + error.what());
}

/// Applies the case to a coarser mesh; nothing if it does not fit, with a warning for files named in the
/// case.
std::optional<Problem> coarse_problem(Case& input, std::size_t dim, const Coarser& coarser) {
  Mesh mesh = load_coarser(coarser, dim);
  try {
    return put_on(input, std::move(mesh));
  } catch (const InputError& error) {
    if (!coarser.named.empty())
      input.warnings.push_back(coarser.named +
                               ": the mesh is passed over, the case does not fit it: " + error.what());
    return std::nullopt;
  }
}

/// Extrapolates u to the next halved mesh: errors of order p + 1, and so the differences between levels,
/// shrink by 2⁻⁽ᵖ⁺¹⁾ per halving (Richardson).
void extrapolate(const CoarseSolution& before, const Part& part, std::span<double> u) {
  const std::vector<double> from = interpolate(before, part).displacement;
  const double share = std::ldexp(1.0, -(cell(part.type).order + 1));
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += share * (u[i] - from[i]);
}

/// Solves on one mesh, starting from `run.solutions` if not empty, and adds the result to `run`.
/// - halved: the next mesh is this one halved.
void solve_level(Case& input, std::size_t dim, const Coarser& coarser, bool halved, const MpiSession& mpi,
                 const RunOptions& options, CoarseRun& run) {
  const double start = MPI_Wtime();
  std::optional<Problem> problem;
  int fits = 0;
  together(mpi, [&] {
    if (mpi.first()) problem = coarse_problem(input, dim, coarser);
    fits = problem.has_value() ? 1 : 0;
  });
  mpi.expect_all_here();
  MPI_Bcast(&fits, 1, MPI_INT, 0, mpi.comm());
  if (fits == 0) return;
  Part part = distribute(problem ? &*problem : nullptr, mpi.comm());
  const Problem* whole = problem ? &*problem : nullptr;
  // Extrapolate if this mesh and the next one are both halvings of the previous one.
  const auto taken_on = [&](Solution solution, std::size_t step) {
    if (step < run.solutions.size() && coarser.halves && halved && run.levels.back().converged)
      extrapolate(run.solutions[step], part, solution.displacement);
    return solution;
  };
  std::vector<CoarseSolution> before;
  Solution solution = solve_roughly(input, part, options, run, [&](const Part& now, const Solution& step) {
    before.push_back(whole_solution(now, whole, taken_on(step, before.size())));
  });
  solution = taken_on(std::move(solution), before.size());
  run.take(solution, std::move(before), part, whole, start, halved);
}

}  // namespace

std::string level_line(const CoarseLevel& level) {
  std::string text = "from a mesh of " + std::to_string(level.unknowns) +
                     " unknowns: " + std::to_string(level.outer_iterations) + " steps, " +
                     std::to_string(level.cg_iterations) + " CG, " + readable_seconds(level.seconds);
  if (level.error > 0.0) text += ", mesh error " + readable_share(level.error);
  return text + "\n";
}

RunOptions silent(const RunOptions& options) {
  RunOptions coarse = options;
  coarse.progress = nullptr;
  coarse.phase = nullptr;
  coarse.stage = nullptr;
  coarse.checkpoint = nullptr;
  coarse.start = nullptr;
  coarse.load_step_over = nullptr;
  return coarse;
}

bool stop_wanted(const MpiSession& mpi, const RunOptions& options) {
  int stop = options.stop_requested && options.stop_requested() ? 1 : 0;
  mpi.expect_all_here();
  MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, mpi.comm());
  return stop != 0;
}

Solution solve_roughly(const Case& input, Part& part, RunOptions options, const CoarseRun& before,
                       std::function<void(const Part&, const Solution&)> step_over) {
  SolverOptions solver = input.model.solver;
  solver.tolerance = std::max(solver.tolerance, coarse_tolerance);
  options.coarse = before.solutions;
  options.load_step_over = std::move(step_over);
  return solve(part, solver, options);
}

void CoarseRun::take(const Solution& of, std::vector<CoarseSolution> before, const Part& part,
                     const Problem* problem, double began, bool halved) {
  const Result& result = of.result;
  const bool converged = result.status == Status::converged;
  if (converged) {
    before.push_back(whole_solution(part, problem, of));
    solutions = std::move(before);
  }
  levels.push_back({result.unknowns, result.outer_iterations, result.cg_iterations,
                    result.operator_applications, MPI_Wtime() - began, converged, halved, 0.0, result.probe,
                    result.contact_force});
}

void note_discretisation(const DiscretisationError& error, const CoarseRun& coarse, Result& result) {
  Discretisation& out = result.discretisation;
  out.energy = error.relative;
  // The uninterrupted sequence of halved meshes that ends with this one.
  std::vector<const CoarseLevel*> levels;
  for (const CoarseLevel& level : coarse.levels) {
    const bool knows = level.converged && level.halved && level.probe.size() == result.probe.size();
    if (!knows) levels.clear();
    if (knows) levels.push_back(&level);
  }
  out.meshes = 1 + static_cast<int>(levels.size());
  if (out.meshes > 1) {
    const auto errors = [&](const Vector3& here, const auto& there) {
      Vector3 of{};
      for (std::size_t c = 0; c < 3; ++c) {
        std::vector<double> values;
        for (const CoarseLevel* level : levels) values.push_back(there(*level)[c]);
        values.push_back(here[c]);
        of[c] = *error_of_last(values);
      }
      return of;
    };
    for (std::size_t i = 0; i < result.probe.size(); ++i)
      out.probe.push_back(errors(result.probe[i], [i](const CoarseLevel& level) { return level.probe[i]; }));
    if (result.contact_nodes > 0)
      out.contact_force =
          errors(result.contact_force, [](const CoarseLevel& level) { return level.contact_force; });
  }
}

CoarseRun solve_coarser(Case& input, std::size_t dim, const MpiSession& mpi, const RunOptions& options) {
  CoarseRun run;
  const Model& model = input.model;
  if (!model.solver.nested || any_moves(model)) return run;
  const RunOptions coarse = silent(options);
  const std::vector<Coarser> meshes = coarser_meshes(input.mesh);
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    if (mpi.first() && options.phase) options.phase("solving on a coarser mesh");
    if (stop_wanted(mpi, options)) break;
    const std::size_t before = run.levels.size();
    // The case's own mesh is the last one halved, unless mesh.files names the last one.
    const bool halved = k + 1 < meshes.size() ? meshes[k + 1].halves : meshes[k].named.empty();
    solve_level(input, dim, meshes[k], halved, mpi, coarse, run);
    if (mpi.first() && !mpi.hosted() && options.progress && run.levels.size() > before)
      std::cout << level_line(run.levels.back()) << std::flush;
  }
  return run;
}

}  // namespace kacanov
