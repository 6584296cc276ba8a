// SPDX-License-Identifier: BSD-3-Clause
// A problem split once into files that the ranks read on their own: part_<rank>.kacanov each, and
// boundary.kacanov with what the first rank needs for output. Files of the machine that wrote them: its byte
// order and layout.
#pragma once

#include <filesystem>

#include "program/loaded_case.hpp"

namespace kacanov {

/// Splits the problem and writes its files, one part in memory at a time, into a folder "unfinished" within
/// this one. Only when all are whole they take the place of an earlier split, boundary.kacanov last, so that
/// a folder with it is whole. Throws InputError (a folder that cannot be written to, a mesh too small for so
/// many parts) or InternalError.
void write_parts(const std::filesystem::path& folder, const Case& input, Problem problem, int parts);

/// How many parts the folder has. Throws InputError naming the file that is missing or damaged, or the keys
/// in which its case differs from this one.
int count_parts(const std::filesystem::path& folder, const Case& input);

/// Reads this rank's part, on the first rank the boundary too: what load_case and keep_boundary give, with
/// the same bits. Collective; what is wrong on any rank (InputError: missing, damaged, of another case or
/// split, not as many as ranks) is printed and ends as ReportedFailure on all.
LoadedCase load_parts(const std::filesystem::path& folder, const Case& input, const MpiSession& mpi);

}  // namespace kacanov
