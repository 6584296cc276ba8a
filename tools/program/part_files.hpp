// SPDX-License-Identifier: BSD-3-Clause
// Files of a problem that is partitioned once and read by every rank separately: part_<rank>.kacanov, and
// boundary.kacanov with the data that the first rank needs for output. Byte order and layout are those of the
// machine.
#pragma once

#include <filesystem>

#include "program/loaded_case.hpp"

namespace kacanov {

/// Partitions the problem and writes its files, one part in memory at a time, into a subfolder "unfinished".
/// Once all are complete they replace an earlier set, boundary.kacanov last, so that a folder with this file
/// is complete. Throws InputError (folder not writable, mesh too small for that many parts) or InternalError.
void write_parts(const std::filesystem::path& folder, const Case& input, Problem problem, int parts);

/// Returns the number of parts in the folder. Throws InputError naming the file that is missing or damaged,
/// or the keys in which its case differs from this one.
int count_parts(const std::filesystem::path& folder, const Case& input);

/// Reads this rank's part, and on the first rank the boundary: the same data, bit for bit, as load_case() and
/// keep_boundary() give. An error on any rank (InputError: missing, damaged, of another case or partition,
/// number of parts differs from ranks) is printed and becomes ReportedFailure on all. Collective.
LoadedCase load_parts(const std::filesystem::path& folder, const Case& input, const MpiSession& mpi);

}  // namespace kacanov
