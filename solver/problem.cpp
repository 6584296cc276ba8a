// SPDX-License-Identifier: BSD-3-Clause
// Puts a model on a mesh, step by step, and checks that what results can be solved.
#include "problem.hpp"

#include <type_traits>

#include "error.hpp"
#include "problem/conditions.hpp"
#include "problem/contact_points.hpp"
#include "problem/probes.hpp"
#include "problem/rigid_modes.hpp"
#include "problem/selection.hpp"

namespace kacanov {

Problem build_problem(Mesh mesh, const Model& model) {
  check_mesh(mesh);
  Problem problem;
  problem.mesh = std::move(mesh);
  const std::size_t unknowns = problem.mesh.coordinates.size();
  problem.load.assign(unknowns, 0.0);
  problem.held.assign(unknowns, 0);
  problem.prescribed.assign(unknowns, 0.0);

  const Selection selection(problem.mesh);
  assign_materials(problem, model, selection);
  assemble_load(problem, model, selection);
  hold_displacements(problem, model, selection);
  find_contact_points(problem, model, selection);
  check_rigid_modes(problem);
  problem.probes = locate_probes(problem.mesh, model);
  return problem;
}

void keep_boundary(Problem& problem) {
  const auto free = [](auto& array) { std::remove_reference_t<decltype(array)>().swap(array); };
  if (problem.mesh.dim() == 3) {
    free(problem.mesh.elements);
    free(problem.mesh.element_tags);
  }
  free(problem.law_of_element);
  free(problem.load);
  free(problem.held);
  free(problem.prescribed);
}

}  // namespace kacanov
