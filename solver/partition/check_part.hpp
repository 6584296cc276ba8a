// SPDX-License-Identifier: BSD-3-Clause
// Whether the fields of a part that was read from a file fit each other.
#pragma once

#include <kacanov/part.hpp>

namespace kacanov {

/// Throws InputError naming the first field of the part of `rank` of `ranks` with a wrong length, an index of
/// something that is not there, or an order that is none: what else would read beyond its arrays. Numbers are
/// not looked at, but for those that a law or an operator refuses by itself. Not collective.
void check_part(const Part& part, int rank, int ranks);

}  // namespace kacanov
