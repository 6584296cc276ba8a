// SPDX-License-Identifier: BSD-3-Clause
// Consistency check of a part that was read from a file.
#pragma once

#include <kacanov/part.hpp>

namespace kacanov {

/// Throws InputError that names the first inconsistent field of part `rank` of `ranks`: a wrong length, an
/// index out of range, or a wrong order, each of which would cause out-of-bounds access later. Values are not
/// checked, except those that a law or an operator rejects itself. Not collective.
void check_part(const Part& part, int rank, int ranks);

}  // namespace kacanov
