// SPDX-License-Identifier: BSD-3-Clause
// Whether the boundary that was read from a file has what the rest of a run looks up in it.
#pragma once

#include <cstdint>
#include <span>

#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>

namespace kacanov {

/// Throws InputError naming the first array of what keep_boundary() leaves that has a wrong length or an
/// index of something that is not there. `nodes`: their numbers in the whole body; part: any of its parts.
void check_boundary(const Problem& problem, std::span<const std::int32_t> nodes, const Part& part);

}  // namespace kacanov
