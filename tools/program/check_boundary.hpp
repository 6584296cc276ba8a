// SPDX-License-Identifier: BSD-3-Clause
// Validates the boundary data that were read from a file.
#pragma once

#include <cstdint>
#include <span>

#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>

namespace kacanov {

/// Throws InputError naming the first array of the boundary data (see keep_boundary()) that has a wrong
/// length or an index out of range. `nodes`: node numbers in the whole body; `part`: any of its parts.
void check_boundary(const Problem& problem, std::span<const std::int32_t> nodes, const Part& part);

}  // namespace kacanov
