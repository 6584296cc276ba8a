// SPDX-License-Identifier: BSD-3-Clause
// Solves a case from its file to its numbers, for commands and for host programs.
#include "program/solve_case.hpp"

#include <kacanov/discretisation.hpp>
#include <kacanov/element_fields.hpp>
#include <kacanov/error.hpp>
#include <kacanov/solve.hpp>
#include <kacanov/validity.hpp>
#include "pictures/picture.hpp"
#include "program/adaptive_run.hpp"
#include "program/coarse_run.hpp"
#include "program/loaded_case.hpp"
#include "program/memory_model.hpp"
#include "program/obstacle_files.hpp"
#include "program/picture_marks.hpp"
#include "program/result_json.hpp"

namespace kacanov {
namespace {

/// Converts a solution of another run to an initial guess; the same on every rank. Collective.
CoarseSolution start_of(const SolvedCase& from, int dim, const MpiSession& mpi) {
  CoarseSolution start;
  together(mpi, [&] {
    if (!mpi.first()) return;
    const Mesh& mesh = from.problem.mesh;
    if (mesh.dim() != dim)
      throw InputError("start: expected a solution in " + std::to_string(dim) + " dimensions, got one in " +
                       std::to_string(mesh.dim()));
    start = {mesh.type, mesh.coordinates, mesh.elements, from.displacement, {}, from.result.lambda_max};
    for (std::size_t i = 0; i < from.problem.contact.size(); ++i) {
      const ContactPoint& point = from.problem.contact[i];
      const double* friction = &from.contact.traction[3 * i];
      start.contact.push_back(
          {point.node, point.entry, from.contact.pressure[i], {friction[0], friction[1], friction[2]}});
    }
  });
  share(start, mpi_communicator(mpi.comm()));
  return start;
}

/// Gathers element values of all ranks, any number per element, in the numbering of the whole mesh; empty if
/// there are none. Collective.
std::vector<double> gather_elements(const Part& part, const std::vector<double>& local) {
  const std::size_t here = local.empty() ? 0 : local.size() / part.element_count();
  const auto width = static_cast<std::size_t>(part.node_map.max_all(static_cast<double>(here)));
  std::vector<double> all(width * static_cast<std::size_t>(part.total_elements), 0.0);
  for (std::size_t k = 0; k < local.size(); ++k) {
    const auto element = static_cast<std::size_t>(part.element_index[k / width]);
    all[width * element + k % width] = local[k];
  }
  if (all.empty()) return all;
  part.node_map.sum_all(all);
  return all;
}

/// Gathers the patch numbers of all nodes on the first rank; empty if there are none. Collective.
std::vector<std::int64_t> gather_patches(const Part& part) {
  if (!part.has_patches()) return {};
  const std::vector<double> local(part.pressure_patch.begin(), part.pressure_patch.end());
  const std::vector<double> all = gather_nodal(part, local, 1);
  return {all.begin(), all.end()};
}

void fields_at(const SolvedCase& solved, std::span<const double> displacement,
               std::span<const double> thermal, const reference::ElementFields& out) {
  const Mesh& mesh = solved.problem.mesh;
  Body body{mesh.view(), solved.problem.laws, solved.problem.law_of_element};
  body.pressure_patch = solved.pressure_patch;
  element_fields(body, {displacement, thermal}, out);
}

/// Collective.
StepFields step_fields(const Part& part, const Solution& now) {
  return {now.result.load_steps.size(), gather_nodal(part, now.displacement, part.dim()),
          gather_elements(part, now.thermal), gather_contact_fields(part, now)};
}

}  // namespace

Solution solve_part(const Case& input, Part& part, const MpiSession& mpi, const RunOptions& options) {
  if (!any_moves(input.model)) return solve(part, input.model.solver, options);
  Model model = with_curves(input.model);
  together(mpi, [&] {  // obstacles are known on the first rank
    if (mpi.first()) model = with_curves(model_with_files(input));
  });
  return solve_moving(part, model, options);
}

void complete_messages(const Case& input, const Problem& problem, Result& result) {
  const std::string cause = likely_cause(problem.warnings);
  if (result.status == Status::not_converged && !cause.empty()) result.message += "; " + cause;
  std::vector<std::string> all = input.warnings;
  all.insert(all.end(), problem.warnings.begin(), problem.warnings.end());
  const std::vector<std::string> found = examine(result, input.model);
  all.insert(all.end(), result.warnings.begin(), result.warnings.end());
  all.insert(all.end(), found.begin(), found.end());
  result.warnings = std::move(all);
}

std::string deformed_picture(const Case& input, const Mesh& mesh, std::span<const double> displacement,
                             const PictureContent& content, double largest_von_mises) {
  DeformedPicture picture;
  picture.title = input.name;
  picture.mesh = &mesh;
  picture.displacement = displacement;
  picture.values = content.values;
  picture.quantity = content.quantity;
  picture.scale = input.output.scale;
  picture.largest_von_mises = largest_von_mises;
  picture.view = content.view == Vector3{} ? input.output.view : content.view;
  if (!content.surroundings) return deformed_svg(picture);
  picture.obstacles = content.obstacles;
  picture.marks = picture_marks(input, mesh);
  for (const ContactEntry& entry : input.model.contact) {
    if (const auto* plane = std::get_if<Plane>(&entry.obstacle); plane != nullptr && !entry.moves())
      picture.planes.push_back({plane->point, plane->normal});
  }
  return deformed_svg(picture);
}

void element_fields(const SolvedCase& solved, const reference::ElementFields& out) {
  fields_at(solved, solved.displacement, solved.thermal, out);
}

void element_fields(const SolvedCase& solved, const StepFields& step, const reference::ElementFields& out) {
  fields_at(solved, step.displacement, step.thermal, out);
}

SolvedCase solve_case(const Case& given, const MpiSession& mpi, const CaseRun& run) {
  const double begin = MPI_Wtime();
  RunOptions options = run.options;
  Case input = given;
  CoarseRun coarse;
  if (given.mesh.adapt) coarse = adapt(input, mpi, options);
  LoadedCase loaded = load_case(input, mpi, run.memory_check);
  input.mesh.adapted.reset();
  const Communicator& all = loaded.part.node_map;
  const bool starts = all.any(run.start != nullptr);
  if (starts && all.any(run.start == nullptr))
    throw InputError("start: expected a solution on all ranks, or on none");
  if (starts)
    coarse.solutions = {start_of(*run.start, loaded.part.dim(), mpi)};
  else if (!given.mesh.adapt)
    coarse = solve_coarser(input, loaded.part.dim(), mpi, options);
  options.coarse = coarse.solutions;
  std::vector<StepFields> steps;
  if (run.keep_steps)
    options.load_step_over = [&](const Part& part, const Solution& now) {
      steps.push_back(step_fields(part, now));
    };
  Solution solution = solve_part(input, loaded.part, mpi, options);
  const double solved = MPI_Wtime();
  coarse.solutions.clear();

  SolvedCase out;
  out.input = input;
  out.steps = std::move(steps);
  const Part& part = loaded.part;
  const auto [nodal, error] = recover_and_estimate(part, solution);
  note_discretisation(error, coarse, solution.result);
  out.pressure_patch = gather_patches(part);
  out.error = gather_elements(part, error.shares());
  out.displacement = gather_nodal(part, solution.displacement, part.dim());
  out.nodal_stress = gather_nodal(part, nodal.stress, 6);
  out.recovered_von_mises = gather_nodal(part, nodal.von_mises, 1);
  out.averaged_von_mises =
      gather_nodal(part, nodal_means(part, element_numbers(part, solution)).von_mises, 1);
  out.contact = gather_contact_fields(part, solution);
  out.thermal = gather_elements(part, solution.thermal);
  out.result = std::move(solution.result);
  out.result.max_von_mises_nodal = nodal.max_von_mises;
  RunFigures figures;
  figures.nested = std::move(coarse.levels);
  figures.sets = loaded.set_names;
  figures.peak_memory_bytes =
      static_cast<std::uint64_t>(part.node_map.sum_all(static_cast<std::int64_t>(peak_memory())));
  figures.read = loaded.read_seconds;
  figures.distribute = loaded.distribute_seconds;
  figures.output = MPI_Wtime() - solved;
  figures.total = MPI_Wtime() - begin;
  std::string text;
  together(mpi, [&] {
    if (!mpi.first()) return;
    out.problem = std::move(*loaded.problem);
    complete_messages(input, out.problem, out.result);
    out.json = result_json(out.result, figures, input, out.problem.mesh);
    if (mpi.ranks() > 1)
      text = out.json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  });
  broadcast(mpi, text);
  if (!mpi.first()) out.json = nlohmann::ordered_json::parse(text);
  return out;
}

}  // namespace kacanov
