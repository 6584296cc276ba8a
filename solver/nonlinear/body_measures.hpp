// SPDX-License-Identifier: BSD-3-Clause
// Volumes of a body, and what single precision holds of it.
#pragma once

#include <span>

#include "linear/space.hpp"

namespace kacanov {

/// Volume of each node of this rank, a share of those of its elements on all ranks; in 2D an area.
/// Collective.
Vector lumped_volume(const Part& part);

/// Throws InputError, on all ranks alike, where stiffnesses (`diagonal`: of the elastic B) or the forces that
/// loads and prescribed displacements come to lie beyond what the preconditioner's single precision holds.
/// Collective.
void refuse_beyond_floats(const Part& part, std::span<const float> diagonal);

}  // namespace kacanov
