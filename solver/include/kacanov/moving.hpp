// SPDX-License-Identifier: BSD-3-Clause
// Solver for obstacles that move, are pushed by a force, or are relinearised at each load step.
#pragma once

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>
#include <kacanov/run_options.hpp>

namespace kacanov {

/// Returns the model with its load steps converted to load curves, which solve_moving() needs; unchanged if
/// no obstacle moves.
Model with_curves(Model model);

/// Solves one load step after the other, each with solve() starting from the end of the previous one, with
/// the obstacles at their current positions (theory: moving-obstacles, force-control).
/// - part: of the problem that build_problem() creates from with_curves(model). Its contact rows and load
///   curves are left as in the last load step.
/// - model: the result of with_curves(); its obstacles' data are needed on rank 0 only.
/// - run: as for solve(); a checkpoint contains the current solve and the completed load steps.
/// Returns the same as solve(), with counts summed over all steps. Throws InputError on all ranks if an
/// obstacle leaves any node without a contact direction. Collective.
Solution solve_moving(Part& part, const Model& model, RunOptions run);

}  // namespace kacanov
