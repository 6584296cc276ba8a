// SPDX-License-Identifier: BSD-3-Clause
// Writes one VTK file of a grid that is distributed over the ranks.
#pragma once

#include <string>

#include "formats/vtu_writer.hpp"
#include "program/parallel.hpp"

namespace kacanov {

/// Writes the shares of all ranks as one grid, in rank order. The first rank writes; the others send it
/// compressed blocks, so that it holds a few megabytes of another rank at most. All ranks need the same field
/// names and types. Errors are handled as in together() and leave no file of that name. Collective.
void write_shared_vtu(const std::string& path, const Grid& share, const MpiSession& mpi);

}  // namespace kacanov
