// SPDX-License-Identifier: BSD-3-Clause
// One file of a grid of which every rank has a share.
#pragma once

#include <string>

#include "formats/vtu_writer.hpp"
#include "program/parallel.hpp"

namespace kacanov {

/// Writes the shares of all ranks as one grid, in the order of the ranks. The first rank writes; others send
/// it blocks that they have packed, some megabyte at a time, so that no rank ever holds more than that of
/// another. Field names and types have to be the same everywhere. What fails ends as together() says, with no
/// file of that name. Collective.
void write_shared_vtu(const std::string& path, const Grid& share, const MpiSession& mpi);

}  // namespace kacanov
