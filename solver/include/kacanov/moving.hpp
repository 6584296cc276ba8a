// SPDX-License-Identifier: BSD-3-Clause
// Solving where obstacles move, are pushed by a force, or are faced anew at each load step.
#pragma once

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>
#include <kacanov/run_options.hpp>

namespace kacanov {

/// The model with its load steps as load curves, which is what obstacles that move are solved along; as it
/// was where none moves.
Model with_curves(Model model);

/// Solves load step by load step, each by solve() from the end of the one before, with obstacles where they
/// are by then (theory: moving-obstacles, force-control).
/// - part: of the problem that build_problem() makes of with_curves(model). Its contact rows and load curves
///   are left as the last load step had them.
/// - model: with_curves() of it; its obstacles' data are needed on rank 0 alone.
/// - run: as for solve(); a checkpoint holds the solve under way and the load steps before it.
/// Returns what solve() does, with counts over all steps. Throws InputError where an obstacle leaves a node
/// no direction, on all ranks alike. Collective.
Solution solve_moving(Part& part, const Model& model, RunOptions run);

}  // namespace kacanov
