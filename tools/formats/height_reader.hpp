// SPDX-License-Identifier: BSD-3-Clause
// Reads height maps, numbers on a grid, from CSV, PBM, PGM and PNG files.
#pragma once

#include <string_view>

#include "formats/number_grid.hpp"
#include "formats/source_file.hpp"

namespace kacanov {

/// `bytes` is the whole file; `source` names it in messages. CSV: numbers separated by commas, semicolons or
/// blanks; lines that begin with # are skipped. PGM (P2, P5): 0 black to 1 white. PBM (P1, P4): its digits, 1
/// for black. PNG: see parse_png(). Throws InputError naming the line, or the position of the value, of an
/// error.
NumberGrid parse_heights(const SourceFile& source, std::string_view bytes);
NumberGrid read_heights(const SourceFile& source);

}  // namespace kacanov
