// SPDX-License-Identifier: BSD-3-Clause
// BoomerAMG below the multigrid's aggregates.
#pragma once

#include <memory>

#include "multigrid/coarse_solver.hpp"

namespace kacanov {

/// Two V-cycles of BoomerAMG on a level over rigid motions (theory: coarse-amg): systems of six unknowns
/// (three in 2D), coarsened row by row, with rotations of the whole body within the interpolation's reach.
/// Throws InputError where hypre cannot number the unknowns. Collective.
std::unique_ptr<CoarseSolver> make_coarse_amg(const CoarseMatrix& matrix);

}  // namespace kacanov
